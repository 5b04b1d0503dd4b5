"""The table of old names: each leads to a filter and parameters that are there today."""

import pytest

from meshlab_willmore.meshset import catalogue, old_names
from meshlab_willmore.meshset.check import examine, resolve
from meshlab_willmore.meshset.parameter_info import keyword_of
from meshlab_willmore.mlx.steps import Param, Reading, Step

pytestmark = pytest.mark.skipif(
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


def test_no_name_stands_twice():
    names = [entry["old"] for entry in TABLE["filters"]]
    assert len(names) == len(set(names))
    assert not set(names) & TABLE["gone"].keys()
    rules = [(e["filter"], e["old"], e["param"]) for e in TABLE["params"]]
    assert len(rules) == len(set(rules))


def test_old_names_stand_as_they_are_looked_up():
    for name in [e["old"] for e in TABLE["filters"] + TABLE["params"]] + list(TABLE["gone"]):
        assert old_names.plain(name) == name


def test_filters_that_are_gone_are_gone():
    for name in TABLE["gone"]:
        assert catalogue.find(name) is None, name


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


def test_it_is_said_where_each_entry_was_found():
    for entry in TABLE["filters"] + TABLE["params"] + TABLE["choices"]:
        assert old_names.age(entry["from"]) <= old_names.age(entry["until"]), entry
        assert entry["source"], entry
    for version in [*TABLE["gone"].values(), *(e["until"] for e in TABLE["defaults"])]:
        assert old_names.age(version) >= 0


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
