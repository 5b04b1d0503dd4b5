"""Several values after one option."""

import pytest

from meshlab_willmore.cli.errors import WrongUse
from meshlab_willmore.cli.masks import by_output, is_part
from meshlab_willmore.cli.spelling import GONE, of_today, spelled_out

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


def test_old_names_become_those_of_today():
    words = ["s.mlx", "-o", "a", "-om", "vc", "-i", "--", "-om", "-p"]
    assert of_today(words) == ["s.mlx", "-o", "a", "-m", "vc", "-i", "--", "-om", "-p"]


@pytest.mark.parametrize("word", GONE)
def test_what_is_gone_is_refused(word):
    with pytest.raises(WrongUse, match=f"^{word} of meshlabserver is gone: "):
        of_today(["s.mlx", word])


@pytest.mark.parametrize(
    ("written", "groups"),
    [
        ("", []),
        ("vc", []),
        ("o", [""]),
        ("vc o vn", ["vc vn"]),
        ("o vc o", ["vc", ""]),
        ("vc o vn o vq fc", ["vc vn", "vc vq fc"]),
    ],
)
def test_parts_belong_to_the_output_before(written, groups):
    words = written.split()
    order = ["patterns" if word == "o" else "parts" for word in words]
    parts = [word for word in words if word != "o"]
    assert by_output(order, parts) == [tuple(group.split()) for group in groups]
