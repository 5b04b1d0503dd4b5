"""The table of stages."""

import pytest

from meshlab_willmore.cli.text import table
from meshlab_willmore.report.stages import LEGEND, Stage, significant, table_rows


@pytest.mark.parametrize(
    ("value", "text"),
    [
        (45.757012, "45.7570"),
        (0.0, "0.00000"),
        (-3.25, "-3.25000"),
        (166259.4, "166259"),
        (12345678.9, "12345679"),
        (1e-9, "0.00000"),
        (99999.96, "100000.0"),
        (123456789012345.0, "123456789012345"),
        (-1.5e78, "-1.50000e+78"),
        (float("-inf"), "-inf"),
        (float("nan"), "nan"),
    ],
)
def test_numbers_have_six_digits_and_an_exponent_only_if_huge(value, text):
    assert significant(value) == text


def test_table_is_laid_out_exactly():
    stages = [
        Stage("cube", "initial", 24, None, 45.757, 6.22709, 47.93, 0.0821, None),
        Stage("cube", "Willmore flips", 24, 6, 29.9173, 6.02993, 23.6376, 0.868, 0.004),
        Stage("scan", "cleaned", 166119, None, 63932.3, 19859.1, 10224.1, 0.425, 0.17),
    ]
    assert table(table_rows(stages), LEGEND) == "\n".join(
        [
            "                   faces  flips        W     area        M  shape  seconds",
            "--------------------------------------------------------------------------",
            "cube",
            "  initial             24         45.7570  6.22709  47.9300  0.082",
            "  Willmore flips      24      6  29.9173  6.02993  23.6376  0.868     0.00",
            "scan",
            "  cleaned         166119         63932.3  19859.1  10224.1  0.425     0.17",
            "--------------------------------------------------------------------------",
            LEGEND,
        ]
    )
