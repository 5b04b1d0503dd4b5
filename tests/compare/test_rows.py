"""Which rows a comparison has."""

from itertools import product

import pytest

import meshlab_willmore
from meshlab_willmore.compare import rows as rows_module
from meshlab_willmore.meshset import filters
from meshlab_willmore.meshset.catalogue import find
from meshlab_willmore.options import ENERGY, SEARCH


def test_there_is_a_row_for_each_search_and_energy_of_the_filter():
    searches, energies = SEARCH.choices, ENERGY.choices
    rows = rows_module.own_rows(iter(searches), iter(energies), {"featuredeg": 30.0})
    assert [(r.search, r.energy) for r in rows] == list(product(searches, energies))
    assert len({r.name for r in (rows_module.INITIAL, *rows, *rows_module.PEERS)}) == len(rows) + 5
    for row in rows:
        assert row.given == {
            "search": row.search,
            "energy": row.energy,
            "featuredeg": 30.0,
            "selection": False,
            "allowloss": True,
        }


def test_presets_take_what_they_do_not_decide():
    given = {"featuredeg": 30.0, "depth": 3}
    paper, faithful = rows_module.preset_rows(["paper", "faithful"], given)
    assert (paper.name, faithful.name) == ("preset paper", "preset faithful")
    assert paper.given["depth"] == 3
    assert faithful.given == {
        "preset": "faithful",
        "featuredeg": 30.0,
        "selection": False,
        "allowloss": True,
    }


@pytest.mark.parametrize("peer", rows_module.PEERS, ids=lambda peer: peer.name)
def test_peers_are_filters_of_meshlab_with_parameters_that_they_have(peer):
    known = find(peer.filter)
    assert not known.is_willmore
    for name, value in peer.given.items():
        param = known.param(name)
        assert param is not None
        assert not param.choices or value in param.choices


def test_warm_up_calls_our_filter_as_it_will_be_called_and_no_other(monkeypatch):
    calls = []

    def note(ms, values):
        calls.append((ms.current_mesh().face_number(), values))
        return {}, ""

    ours = filters.BY_NAME[rows_module.FILTER]
    monkeypatch.setitem(filters.BY_NAME, rows_module.FILTER, ours._replace(run=note))
    meshlab_willmore.unregister()
    try:
        meshlab_willmore.register()
        rows_module.warm_up(rows_module.FILTER, {"featuredeg": 12.0})
    finally:
        meshlab_willmore.unregister()
        monkeypatch.undo()
        meshlab_willmore.register()
    rows_module.warm_up(rows_module.PLANAR, {"iterations": "nonsense"})
    rows_module.warm_up("", {})
    ((faces, values),) = calls
    assert (faces, values["featuredeg"]) == (24, 12.0)
