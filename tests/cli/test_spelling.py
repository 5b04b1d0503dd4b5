"""Several values after one option."""

import pytest

from meshlab_willmore.cli.masks import is_part
from meshlab_willmore.cli.spelling import spelled_out

SEVERAL = {"-i": lambda word: not word.endswith(".mlx"), "-m": is_part}


@pytest.mark.parametrize(
    ("written", "meant"),
    [
        ("", ""),
        ("s.mlx -i a", "s.mlx -i a"),
        ("-i a b c -o x y", "-i a -i b -i c -o x y"),
        ("-i a -i b c", "-i a -i b -i c"),
        ("-i a s.mlx b", "-i a s.mlx b"),
        ("-m vc vn fq out.ply", "-m vc -m vn -m fq out.ply"),
        # The first word is the option's even if it is wrong, so that click says so.
        ("-m xx vc", "-m xx -m vc"),
        ("-i s.mlx", "-i s.mlx"),
        ("-i a - b", "-i a -i - -i b"),
        ("-i a -- b c", "-i a -- b c"),
        ("-o -i a", "-o -i a"),
        ("-ia b", "-ia b"),
    ],
)
def test_each_value_gets_the_options_name(written, meant):
    assert spelled_out(written.split(), SEVERAL) == meant.split()
