from pathlib import Path

import pymeshlab

from meshlab_willmore.mlx.read import read, read_bytes
from meshlab_willmore.mlx.steps import Param, Percentage, Step
from meshlab_willmore.mlx.write import to_xml

from .scripts import one_param, script

SAMPLE = Path(pymeshlab.__file__).parent / "tests/sample_meshes/sample_filter_script.mlx"


def test_pymeshlabs_own_sample_is_read():
    box, subdivided, butterfly = read(SAMPLE)
    assert box == Step(
        "Box/Cube",
        (
            Param(
                "size",
                "RichFloat",
                2.0,
                (("description", "Scale factor"), ("tooltip", "Scales the new mesh")),
            ),
        ),
    )
    assert subdivided == Step("Subdivision Surfaces: Catmull-Clark")
    assert butterfly.filter == "Subdivision Surfaces: Butterfly Subdivision"
    assert [(p.name, p.type, p.value) for p in butterfly.params] == [
        ("Iterations", "RichInt", 2),
        ("Threshold", "RichAbsPerc", 0.034641),
        ("Selected", "RichBool", False),
    ]
    details = dict(butterfly.params[1].details)
    assert list(details) == ["description", "min", "max", "tooltip"]
    assert details["tooltip"].startswith("All the edges <b>longer</b> than")


def test_a_script_without_steps_is_one():
    assert read_bytes(b"<FilterScript/>", "s") == ()
    assert read_bytes(script(""), "s") == ()


def test_comments_declarations_and_space_are_nothing():
    data = (
        b'<?xml version="1.0"?>\n<!-- for the face -->\n<!DOCTYPE FilterScript>\n<FilterScript>'
        b'<!-- first --><filter name="F"><!-- <Param/> -->\r\n\t<Param name="p" type="RichInt" '
        b'value="1"> <!-- one --> </Param></filter><?pi x?></FilterScript>\n<!-- end -->\n'
    )
    assert read_bytes(data, "s") == (Step("F", (Param("p", "RichInt", 1),)),)


def test_old_attributes_stay_as_details():
    data = script(
        '<filter name="F" isxmlparam="0">'
        '<Param name="p" type="RichPoint3f" isxmlparam="0" x="1" y="2" z="3"/></filter>'
    )
    param = Param("p", "RichPoint3f", (1.0, 2.0, 3.0), (("isxmlparam", "0"),))
    assert read_bytes(data, "s") == (Step("F", (param,)),)


def test_the_form_without_types_keeps_the_texts():
    data = script(
        '<xmlfilter name="A"><xmlparam name="p" value="[1 2]"/><xmlparam value="" name="q"/>'
        '</xmlfilter><filter name="B"/><xmlfilter name="C"/>'
    )
    old = Step("A", (Param("p", "", "[1 2]"), Param("q", "", "")))
    assert read_bytes(data, "s") == (old, Step("B"), Step("C"))


def test_a_percentage_value_is_a_share_of_meshlabs_type():
    by_sign = read_bytes(one_param(kind="RichAbsPerc", value="5%"), "s")
    by_type = read_bytes(one_param(kind="PercentageValue", value="5"), "s")
    assert by_sign == by_type == (Step("F", (Param("p", "RichAbsPerc", Percentage(5.0)),)),)


def test_attributes_of_any_name_are_kept():
    data = one_param(kind="RichInt", value="1", **{"xml:lang": "de", "Übersetzt": "ja"})
    (step,) = read_bytes(data, "s")
    assert step.params[0].details == (("xml:lang", "de"), ("Übersetzt", "ja"))
    assert read_bytes(to_xml([step]).encode(), "s") == (step,)


def test_the_same_parameter_may_be_in_two_steps():
    body = '<filter name="F"><Param name="p" type="RichInt" value="1"/></filter>'
    step = Step("F", (Param("p", "RichInt", 1),))
    assert read_bytes(script(body * 2), "s") == (step, step)


def test_the_path_may_be_a_str_or_a_path(tmp_path):
    path = tmp_path / "s.mlx"
    path.write_bytes(script('<filter name="F"/>'))
    assert read(path) == read(str(path)) == (Step("F"),)
