"""Native messages as plain text."""

import pytest

from meshlab_willmore.markup import plain

POISSON = (
    "Filter requires correct per vertex normals.<br>E.g. <b>ALL</b> the input vertices have a "
    "proper, not-null normal.<br> Try enabling the <i>pre-clean<i> option.<br><br>Use the "
    "<i>Remove Unreferenced Vertices</i> filterIf you encounter this on a pointcloud try the "
    "<i>Conditional Vertex Selection</i> filterwith function '(nx==0.0) && (ny==0.0)'.<br>"
)


@pytest.mark.parametrize(
    ("message", "text"),
    [
        (
            POISSON,
            "Filter requires correct per vertex normals. E.g. ALL the input vertices have a "
            "proper, not-null normal. Try enabling the pre-clean option. Use the Remove "
            "Unreferenced Vertices filter. If you encounter this on a pointcloud try the "
            "Conditional Vertex Selection filter with function '(nx==0.0) && (ny==0.0)'.",
        ),
        ("with faces,<br> not on\n points", "with faces, not on points"),
        ("field.<BR/>Make sure", "field. Make sure"),
        ('on the<a href="https://x.org/a?b=1">Password Settings</a>.', "on the Password Settings."),
        ("one</i><b>two</b>,<u>three</u>(<i>four</i>)", "one two, three (four)"),
        ("<p>first</p><ul><li>second</li></ul>", "first second"),
        ("a &lt; b &amp;&amp; c &#62; d&nbsp;e", "a < b && c > d e"),
    ],
)
def test_markup_is_gone_and_words_stay_apart(message, text):
    assert plain(message) == text


@pytest.mark.parametrize(
    "message",
    ["a < b", "x<b y>z", "if a <b and c> d", "x && y & z; &nothing; &lt", "two  blanks\nand lines"],
)
def test_what_is_no_markup_stays_to_the_letter(message):
    assert plain(message) == message


def test_what_users_wrote_stays():
    message = 'No attribute called "<b>&amp;"<br>You can create <i>one</i>'
    assert plain(message, "<b>&amp;") == 'No attribute called "<b>&amp;" You can create one'
