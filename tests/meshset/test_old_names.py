"""Old names: each leads to a filter and parameters of today, and messages say what changes."""

import pytest

from meshlab_willmore.meshset import catalogue, old_names
from meshlab_willmore.meshset.check import examine, resolve
from meshlab_willmore.meshset.filter_info import keyword_of
from meshlab_willmore.mlx.read import read_bytes
from meshlab_willmore.mlx.steps import Param, Percentage, Reading, Step

recorded_here = pytest.mark.skipif(
    catalogue.version() != catalogue.recorded_version(),
    reason="another PyMeshLab than the one that the names of today were recorded with",
)
TABLE = old_names._file()
TODAY = {name for known in catalogue.everything() for name in (known.name, known.meshlab_name)}
TARGETS = [(entry["old"], to) for entry in TABLE["filters"] for to in entry.get("to", [entry])]


def known_of(entry):
    known = catalogue.find(entry["filter"])
    assert known is not None, entry
    assert known.name == entry["filter"], entry
    return known


@recorded_here
def test_each_old_name_leads_to_a_filter_of_today():
    assert len(TABLE["filters"]) > 100
    for old, to in TARGETS:
        known = known_of(to)
        assert old not in TODAY
        assert catalogue.find(old) is not None
        for name, value in to.get("given", {}).items():
            own = known.param(name)
            assert own is not None, (old, name)
            assert own.name == name
            assert not own.choices or 0 <= value < len(own.choices)


@recorded_here
def test_no_name_is_listed_twice():
    names = [entry["old"] for entry in TABLE["filters"]]
    assert len(names) == len(set(names))
    assert not set(names) & TABLE["removed"].keys()
    rules = [(e["filter"], e["old"], e["param"]) for e in TABLE["params"]]
    assert len(rules) == len(set(rules))


@recorded_here
def test_old_names_are_written_as_they_are_looked_up():
    for name in [e["old"] for e in TABLE["filters"] + TABLE["params"]] + list(TABLE["removed"]):
        assert old_names.plain(name) == name


@recorded_here
def test_filters_that_are_gone_are_gone():
    for name in TABLE["removed"]:
        assert catalogue.find(name) is None, name


@recorded_here
def test_each_old_parameter_leads_to_one_of_today_or_is_gone():
    for entry in TABLE["params"]:
        known = known_of(entry)
        assert known.param(entry["old"]) is None, entry
        if entry["param"] is not None:
            own = known.param(entry["param"])
            assert own is not None, entry
            assert own.name == entry["param"], entry
            for index in entry.get("as", {}).get("values", {}).values():
                assert 0 <= index < len(own.choices), entry


@recorded_here
def test_what_parameters_are_asked_for_is_there():
    for entry in TABLE["choices"]:
        own = known_of(entry).param(entry["param"])
        assert len(entry["old"]) == len(entry["now"])
        assert tuple(entry["old"]) != own.choices
        assert max(entry["now"]) < len(own.choices)
    for entry in TABLE["defaults"]:
        assert known_of(entry).param(entry["param"]).name == entry["param"]
    for name, params in TABLE["expressions"].items():
        known = known_of({"filter": name})
        assert [known.param(p).type for p in params] == ["RichString"] * len(params)


@recorded_here
def test_each_entry_has_its_source():
    for entry in TABLE["filters"] + TABLE["params"] + TABLE["choices"]:
        assert old_names.age(entry["from"]) <= old_names.age(entry["until"]), entry
        assert entry["source"], entry
    for version in [*TABLE["removed"].values(), *(e["until"] for e in TABLE["defaults"])]:
        assert old_names.age(version) >= 0


@recorded_here
@pytest.mark.parametrize("entry", TABLE["filters"], ids=lambda entry: entry["old"])
def test_each_old_name_can_be_run(entry):
    needed = [
        Param(own.name, own.type, "file")
        for own in catalogue.find(entry["old"]).params
        if own.required and own.name not in entry.get("given", {})
    ]
    (call,) = resolve([Step(entry["old"], tuple(needed))], "here")
    to = entry.get("to", [entry])[0]
    assert call.known.name == to["filter"]
    for name, value in to.get("given", {}).items():
        assert call.given[keyword_of(name)] == value


VALUES = {
    "RichBool": True,
    "RichInt": 1,
    "RichFloat": 0.5,
    "RichDynamicFloat": 100.0,
    "RichAbsPerc": 0.5,
    "RichEnum": 1,
    "RichMesh": 0,
    "RichString": "x",
    "RichColor": (1, 2, 3, 255),
    "RichPoint3f": (0.0, 0.0, 1.0),
}


@recorded_here
@pytest.mark.parametrize(
    "entry", TABLE["params"], ids=lambda entry: f"{entry['filter']}-{entry['old']}"
)
def test_each_old_parameter_is_taken(entry):
    """With a type, and as the text of the form without types."""
    known = catalogue.find(entry["filter"])
    value = VALUES[entry["type"]]
    text = " ".join(map(str, value)) if isinstance(value, tuple) else str(value).lower()
    given = []
    for kind, written in [(entry["type"], value), ("", text)]:
        details = (("min", "0"), ("max", "1")) if kind == "RichAbsPerc" else ()
        step = Step(known.name, (Param(entry["old"], kind, written, details),))
        found = examine(Reading((step,)))
        assert [f.text for f in found.faults if f.param == entry["old"]] == []
        assert any(warning.param == entry["old"] for warning in found.warnings)
        (call,) = found.calls
        given.append(call.given)
    assert given[0] == given[1]
    if entry["param"] is None:
        assert given[0] == {}
    else:
        assert keyword_of(entry["param"]) in given[0]


# --- what an old step means today --------------------------------------------------------------

MOVE = "Transform: Move, Translate, Center"
TRANSLATE = "Transform: Translate, Center, set Origin"


def one(name, **params):
    """The given parameters of one step without types."""
    step = Step(name, tuple(Param(key, "", text) for key, text in params.items()))
    (call,) = resolve([step], "here")
    return call.known.name, call.given


def warnings_of(*steps):
    return examine(Reading(steps)).warnings


def enum(name, value, *choices, cardinality=None):
    names = tuple((f"enum_val{i}", choice) for i, choice in enumerate(choices))
    return Param(
        name, "RichEnum", value, (("enum_cardinality", str(cardinality or len(choices))), *names)
    )


@pytest.mark.parametrize(
    ("name", "params", "today", "given"),
    [
        (
            "Remove Faces from Non Manifold Edges",
            {},
            "meshing_repair_non_manifold_edges",
            {"method": 0},
        ),
        (
            "Repair non Manifold Edges by splitting vertices",
            {},
            "meshing_repair_non_manifold_edges",
            {"method": 1},
        ),
        (
            "Remove T-Vertices by Edge Flip",
            {"Threshold": "30"},
            "meshing_remove_t_vertices",
            {"method": 1, "threshold": 30.0},
        ),
        (
            "Transform: Rotate",
            {"ToAll": "true"},
            "compute_matrix_from_rotation",
            {"alllayers": True},
        ),
        (MOVE, {"centerFlag": "true"}, "compute_matrix_from_translation", {"traslmethod": 2}),
        (
            MOVE,
            {"centerFlag": "false", "axisX": "2"},
            "compute_matrix_from_translation",
            {"traslmethod": 0, "axisx": 2.0},
        ),
        (
            "Crease Marking with NonFaux Edges",
            {"AngleDeg": "30"},
            "compute_selection_crease_per_edge",
            {"angledegneg": -30.0, "angledegpos": 30.0},
        ),
        (
            "Vertex Color Filling",
            {"r": "10", "g": "20"},
            "set_color_per_vertex",
            {"color1": (10, 20, 255, 255)},
        ),
        (
            "Alpha Wrap",
            {"Alpha fraction": "0.05"},
            "generate_alpha_wrap",
            {"alpha": Percentage(5.0)},
        ),
        (
            "Compute curvature principal directions",
            {"CurvatureType": "2"},
            "compute_curvature_principal_directions_per_vertex",
            {"curvcolormethod": 6},
        ),
        (
            "Surface Reconstruction: Poisson",
            {"OctDepth": "9", "SolverDivide": "7", "SamplesPerNode": "2", "Offset": "1"},
            "generate_surface_reconstruction_screened_poisson",
            {"depth": 9, "samplespernode": 2.0},
        ),
        (
            "Variable density Disk Sampling",
            {"RadiusVariance": "3"},
            "generate_sampling_poisson_disk",
            {"radiusvariance": 3.0},
        ),
        (
            "Variable density Disk Sampling",
            {},
            "generate_sampling_poisson_disk",
            {"radiusvariance": 2.0},
        ),
        (
            "Recompute Angle Weighted Vertex Normals",
            {},
            "compute_normal_per_vertex",
            {"weightmode": 2},
        ),
        (
            "Select Folded Faces",
            {"AngleThreshold": "150"},
            "compute_selection_bad_faces",
            {
                "usear": False,
                "usenf": False,
                "select_folded_faces": True,
                "folded_faces_angle_threshold": 150.0,
            },
        ),
        (
            "CSG Operation",
            {"FirstMesh": "0", "SecondMesh": "1", "Operator": "2", "SubDelta": "32"},
            "generate_boolean_difference",
            {"first_mesh": 0, "second_mesh": 1},
        ),
        (
            "Directional Geom. Preserv.",
            {"step": "1", "viewPoint": "0 0 1"},
            "apply_coord_directional_preservation",
            {"attr_name": "SavedVertPosition", "viewpoint": (0.0, 0.0, 1.0)},
        ),
        (
            "Conditional Face Selection",
            {"condSelect": "(q0 > 1 and q1 > 1) or border"},
            "compute_selection_by_condition_per_face",
            {"condselect": "(q0 > 1 && q1 > 1) || border"},
        ),
        ("  Taubin\u00a0 Smooth ", {" mu ": "-0.5"}, "apply_coord_taubin_smoothing", {"mu": -0.5}),
    ],
    ids=lambda value: value if isinstance(value, str) else "",
)
def test_an_old_step_means_what_it_meant(name, params, today, given):
    assert one(name, **params) == (today, given)


def test_choices_that_stood_in_another_order_keep_their_meaning():
    old = ("XYZ translation", "Center on BBox", "Set new Origin")
    for choice in (enum("traslMethod", 2, *old), enum("traslMethod", 2, cardinality=3)):
        step = Step(TRANSLATE, (choice,))
        (call,) = resolve([step], "here")
        assert call.given == {"traslmethod": 3}
        assert [w.text for w in warnings_of(step)] == ["choice 2, 'Set new Origin', is 3 today"]


def test_todays_choices_are_left_alone():
    now = ("XYZ translation", "Center on Scene BBox", "Center on Layer BBox", "Set new Origin")
    step = Step(TRANSLATE, (enum("traslMethod", 2, *now),))
    (call,) = resolve([step], "here")
    assert call.given == {"traslmethod": 2}
    assert warnings_of(step) == ()


def test_names_that_meshlab_mixed_up_mean_what_was_done():
    mixed = ("None (avg)", "By Angle", "By Area", "As defined by N. Max")
    step = Step("Compute Vertex Normals", (enum("weightMode", 1, *mixed),))
    (call,) = resolve([step], "here")
    assert call.given == {"weightmode": 1}
    assert "'By Area'" in warnings_of(step)[1].text


def test_choices_may_be_given_by_the_names_that_they_had():
    for choice, index in [("Border_Distance", 2), ("Region Area", 3)]:
        assert one("Voronoi Sampling", colorStrategy=choice)[1] == {"colorstrategy": index}
    assert one(TRANSLATE, traslMethod="Center on BBox")[1] == {"traslmethod": 1}


def test_choices_that_are_only_reworded_are_no_news():
    choices = ("per-Vertex", "per-Face")
    assert warnings_of(Step("Ambient Occlusion", (enum("occMode", 1, *choices),))) == ()


def test_warnings_distinguish_another_result_from_another_name():
    step = Step(
        "Surface Reconstruction: Poisson",
        (
            Param("OctDepth", "RichInt", 8),
            Param("SolverDivide", "RichInt", 8),
            Param("Offset", "RichFloat", 2.0),
        ),
    )
    found = [(w.param, w.changes_result) for w in warnings_of(step)]
    assert found[:4] == [("", True), ("OctDepth", False), ("SolverDivide", False), ("Offset", True)]
    assert "Screened Poisson" in warnings_of(step)[0].text


def test_a_script_of_today_has_no_warning():
    step = Step("Hausdorff Distance", (Param("SampleVert", "RichBool", True),))
    assert warnings_of(step, Step("Remeshing: Isotropic Explicit Remeshing")) == ()


def test_changed_defaults_are_reported_where_the_script_shows_its_age():
    hausdorff = Step("Hausdorff Distance", (Param("SampleFace", "RichBool", True),))
    found = warnings_of(hausdorff, Step("Box"))
    assert [(w.step, w.param) for w in found] == [(2, ""), (1, "SampleEdge")]
    assert "it was true until MeshLab 2017.06, and is false today" in found[1].text
    # A name that 2021 still had proves no such age.
    newer = Step("Repair non Manifold Edges by splitting vertices")
    assert [w.step for w in warnings_of(hausdorff, newer)] == [2]


def test_an_old_attribute_shows_age_as_well():
    data = (
        b"<FilterScript><filter name='Remeshing: Isotropic Explicit Remeshing'>"
        b"<Param name='Adaptive' type='RichBool' value='false' isxmlparam='0'/>"
        b"</filter></FilterScript>"
    )
    (warning,) = warnings_of(*read_bytes(data, "s"))
    assert (warning.param, warning.changes_result) == ("Iterations", True)


@pytest.mark.parametrize(
    ("name", "param", "said"),
    [
        (MOVE, Param("centerFlag", "", "maybe"), "'maybe' is neither 'true' nor 'false'"),
        ("Vertex Color Filling", Param("r", "RichFloat", 300.0), "is not between 0 and 255"),
        ("Alpha Wrap", Param("Alpha fraction", "RichString", "x"), "is not a number: 'x'"),
        (
            "Compute curvature principal directions",
            Param("CurvatureType", "RichEnum", 7),
            "there was no choice 7; they were 0, 1, 2",
        ),
    ],
)
def test_values_that_never_were_are_faults(name, param, said):
    (fault,) = examine(Reading((Step(name, (param,)),))).faults
    assert (fault.text, fault.param) == (said, param.name)


def test_an_old_and_todays_name_of_one_parameter():
    both = (Param("ToAll", "RichBool", True), Param("allLayers", "RichBool", False))
    (fault,) = examine(Reading((Step("Transform: Rotate", both),))).faults
    assert fault.text == "is given twice, also as 'ToAll'"


def test_a_filter_that_is_gone_is_named_as_such():
    (fault,) = examine(Reading((Step("Global registration"),))).faults
    assert fault.text == "MeshLab had this filter until 2020.12, and has none in its place"
