import re

import pymeshlab
import pytest
from hypothesis import given, settings

from meshlab_willmore.meshset.native import muted
from meshlab_willmore.mlx import rich
from meshlab_willmore.mlx.read import read, read_bytes
from meshlab_willmore.mlx.steps import Fault, Param, Percentage, ScriptError, Step
from meshlab_willmore.mlx.write import SOURCE, to_xml, write

from . import scripts

# MeshLab takes the old name of a type for today's.
NATIVE_TYPES = tuple(type for type in rich.TYPES if type != "RichPoint3f")


def exactly(steps):
    """The steps as text, where 0.0 and -0.0, or 1 and 1.0, aren't the same."""
    return repr(steps)


@given(scripts.steps())
@pytest.mark.slow
def test_any_steps_survive_writing_and_reading(steps):
    assert exactly(read_bytes(to_xml(steps).encode(), "s")) == exactly(steps)


@given(scripts.steps())
@pytest.mark.slow
def test_writing_again_gives_the_same_text(steps):
    text = to_xml(steps)
    assert to_xml(read_bytes(text.encode(), "s")) == text


def reloaded(path):
    """What PyMeshLab makes of a script: the steps of the script that it saves after loading."""
    ms = pymeshlab.MeshSet()
    with muted():
        ms.load_filter_script(str(path))
    again = path.with_name("native.mlx")
    ms.save_filter_script(str(again))
    return read(again)


def as_written(step):
    return step.filter, [(p.name, p.type, p.value) for p in step.params]


def test_meshlab_reads_every_type_as_meant(tmp_path):
    params = (
        Param("yes", "RichBool", True),
        Param("no", "RichBool", False),
        Param("int", "RichInt", -(2**31)),
        Param("float", "RichFloat", 1.5e-7),
        Param("string", "RichString", "a \"quoted\" & 'named' <b>\n\ttext ü 日本 😀 "),
        Param("enum", "RichEnum", 1),
        Param("share", "RichAbsPerc", 0.034641),
        Param("dynamic", "RichDynamicFloat", -250.5),
        Param("color", "RichColor", (255, 0, 128, 7)),
        Param("position", "RichPosition", (1.0, -2.5, 1e20)),
        Param("direction", "RichDirection", (0.0, 0.0, 1.0)),
        Param("matrix", "RichMatrix44f", tuple(i / 8 for i in range(16))),
        Param("mesh", "RichMesh", 3),
        Param("open", "RichOpenFile", "folder/a b.png"),
        Param("save", "RichSaveFile", "c.png"),
        Param("shot", "RichShotf", None),
    )
    assert {param.type for param in params} == set(NATIVE_TYPES)
    steps = (Step('Invert & "more"', params), Step("Second"))
    write(tmp_path / "s.mlx", steps)
    assert list(map(as_written, reloaded(tmp_path / "s.mlx"))) == list(map(as_written, steps))


@settings(max_examples=40)
@given(scripts.steps(NATIVE_TYPES))
def test_meshlab_drops_nothing_of_what_is_written(tmp_path_factory, steps):
    kept = [
        step._replace(params=tuple(p for p in step.params if not isinstance(p.value, Percentage)))
        for step in steps
    ]
    path = tmp_path_factory.mktemp("native") / "s.mlx"
    write(path, steps)
    native = reloaded(path)
    assert [as_written(step)[0] for step in native] == [step.filter for step in steps]
    for step, other in zip(kept, native, strict=True):
        assert [p[:2] for p in step.params] == [p[:2] for p in other.params]
        for param, loaded in zip(step.params, other.params, strict=True):
            assert_close(loaded.value, param.value)


def assert_close(loaded, value):
    if isinstance(value, (float, tuple)):
        assert loaded == pytest.approx(value, rel=1e-5, abs=1e-44)
    else:
        assert loaded == value


def test_the_text_looks_as_meshlab_writes_it():
    steps = [
        Step("A", (Param("x", "RichFloat", 2.0, (("tooltip", 'a "b" <c>'),)),)),
        Step("B"),
    ]
    assert to_xml(steps) == (
        "<!DOCTYPE FilterScript>\n"
        "<FilterScript>\n"
        ' <filter name="A">\n'
        '  <Param name="x" type="RichFloat" value="2" tooltip="a &quot;b&quot; &lt;c&gt;"/>\n'
        " </filter>\n"
        ' <filter name="B"/>\n'
        "</FilterScript>\n"
    )
    assert to_xml([]) == "<!DOCTYPE FilterScript>\n<FilterScript/>\n"


@pytest.mark.parametrize(
    ("steps", "faults"),
    [
        ([Step("F", (Param("p", "", "1"),))], ["has no type; look up the filter's own first"]),
        ([Step("F", (Param("p", "RichInt", 1.5),))], ["1.5 is not an int"]),
        (
            [Step("F", (Param("p", "RichInt", 2**31),))],
            ["value='2147483648' is not between -2147483648 and 2147483647"],
        ),
        (
            [Step("F", (Param("p", "RichFloat", float("inf")),))],
            ["value='inf' is not a finite number"],
        ),
        (
            [Step("F", (Param("p", "RichFloat", 1e-300),))],
            ["value='1e-300' is too close to zero for MeshLab to read; write 0"],
        ),
        (
            [Step("F", (Param("p", "RichColor", (0, 0, 0, 256)),))],
            ["a='256' is not between 0 and 255"],
        ),
        (
            [Step("F", (Param("p", "RichString", "a\0"),))],
            ["the value holds U+0000, a character that XML can't hold"],
        ),
        (
            [Step("F", (Param("p", "RichString", "\ud800", (("tooltip", "\ud800"),)),))],
            ["the value holds U+D800, a character that XML can't hold"],
        ),
        (
            [Step("F", (Param("p", "RichInt", 1, (("tooltip", "\x1b[0m"),)),))],
            ["the tooltip holds U+001B, a character that XML can't hold"],
        ),
        (
            [Step("F", (Param("p", "RichInt", 1), Param("p", "RichInt", 2)))],
            ["is given twice"],
        ),
        (
            [Step("F", (Param("p", "RichInt", 1.5), Param("p", "RichBool", 0)))],
            ["1.5 is not an int", "0 is not a bool"],
        ),
    ],
)
def test_what_would_not_be_read_back_is_not_written(steps, faults):
    with pytest.raises(ScriptError) as caught:
        to_xml(steps)
    assert caught.value.faults == tuple(Fault(text, 1, "F", "p") for text in faults)
    assert caught.value.source == SOURCE


@pytest.mark.parametrize(
    ("steps", "fault"),
    [
        (
            [Step("F"), Step("\x07")],
            Fault("the name holds U+0007, a character that XML can't hold", 2, "\x07"),
        ),
        ([Step("F"), Step("")], Fault("the filter (line 4) has no name", 2)),
    ],
)
def test_a_filter_without_a_proper_name_is_not_written(steps, fault):
    with pytest.raises(ScriptError) as caught:
        to_xml(steps)
    assert caught.value.faults == (fault,)


def test_a_script_is_written_atomically(tmp_path):
    path = tmp_path / "s.mlx"
    write(path, [Step("Before")])
    with pytest.raises(ScriptError):
        write(path, [Step("After"), Step("")])
    assert read(path) == (Step("Before"),)
    write(str(path), [Step("Ünicode")])
    assert read(path) == (Step("Ünicode"),)
    assert [file.name for file in tmp_path.iterdir()] == ["s.mlx"]


def test_a_path_that_can_not_be_written_is_named(tmp_path):
    path = tmp_path / "none" / "s.mlx"
    problem = re.escape(f"cannot write {path}: No such file or directory")
    with pytest.raises(OSError, match=f"^{problem}$"):
        write(path, [])


def test_a_full_disk_leaves_the_existing_script(tmp_path, monkeypatch):
    path = tmp_path / "s.mlx"
    write(path, [Step("Before")])

    def write_a_half(self, data):
        with open(self, "wb") as file:
            file.write(data[: len(data) // 2])
        raise OSError(28, "No space left on device")

    monkeypatch.setattr("pathlib.Path.write_bytes", write_a_half)
    problem = re.escape(f"cannot write {path}: No space left on device")
    with pytest.raises(OSError, match=f"^{problem}$"):
        write(path, [Step("After")])
    assert read(path) == (Step("Before"),)
    assert [file.name for file in tmp_path.iterdir()] == ["s.mlx"]
