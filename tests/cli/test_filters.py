"""`filters`: the list, a search in it, and one filter."""

import pymeshlab
import pytest

from meshlab_willmore import script
from meshlab_willmore.meshset.filters import FILTERS

from .conftest import call, cube_file, same_mesh

FLIP = "meshing_edge_flip_by_willmore_optimization"


def test_list_has_every_filter_with_ours_first():
    result = call("filters")
    names = [line.split()[0] for line in result.stdout.splitlines() if line[0] != " "]
    ours = sorted(filter_.name for filter_ in FILTERS)
    assert names[: len(ours)] == ours
    assert names[len(ours) :] == sorted(set(pymeshlab.filter_list()) - set(ours))
    assert "Taubin Smooth" in result.stdout


def test_words_narrow_the_list():
    text = call("filters", "smooth", "Laplacian").stdout
    # Where both names are long, the second is below the first.
    lines = text.replace("\n    ", " ").splitlines()
    assert len(lines) > 1
    assert all("laplacian" in line.lower() and "smooth" in line.lower() for line in lines)


@pytest.mark.parametrize("name", ["apply_coord_taubin_smoothing", "Taubin Smooth"])
def test_native_filter_is_explained(name):
    result = call("filters", name)
    assert result.stdout.splitlines()[:2] == [
        "apply_coord_taubin_smoothing",
        "  in MeshLab: Taubin Smooth",
    ]
    assert "  stepSmoothNum (keyword stepsmoothnum): RichInt, default 10\n" in result.stdout
    assert "filter_list.html#apply_coord_taubin_smoothing" in result.stdout


def test_our_filters_are_explained_with_tooltips_and_results():
    text = call("filters", FLIP).stdout
    words = " ".join(text.split())
    assert max(map(len, text.splitlines())) <= 80
    (filter_,) = (filter_ for filter_ in FILTERS if filter_.name == FLIP)
    for parameter in filter_.parameters:
        assert f"  {parameter.name}: Rich" in text
        assert parameter.tooltip in words
        assert all(f": {choice}\n" in text for choice in parameter.choices)
    for name, kind, meaning in filter_.returns:
        assert f"{name} ({kind}) {meaning}" in words
    assert "featuredeg: RichFloat, default 180\n" in text
    assert "energy: RichEnum, default 'virtual willmore'\n" in text


def test_choices_of_a_native_filter_are_listed():
    text = call("filters", "generate_resampled_uniform_mesh").stdout
    assert "CellSize (keyword cellsize): RichAbsPerc, default " in text
    text = call("filters", "meshing_repair_non_manifold_edges").stdout
    assert "      0: Remove Faces\n      1: Split Vertices\n" in text


def test_unknown_name_suggests_the_closest():
    result = call("filters", "Taubn", "Smooth")
    assert (result.exit_code, result.stdout) == (2, "")
    assert result.stderr.startswith("Error: there is no filter 'Taubn Smooth'; the closest are")
    assert "Taubin Smooth" in result.stderr
    assert result.stderr.count("\n") == 1


def test_every_filter_is_explained():
    # PyMeshLab has no defaults where a mesh lacks what the filter needs.
    names = pymeshlab.filter_list()
    results = {name: call("filters", name) for name in names}
    failed = {n: r.stderr for n, r in results.items() if r.exit_code or r.stderr}
    assert failed == {}
    assert all(results[name].stdout.startswith(f"{name}\n") for name in names)


def test_the_list_fits_80_columns():
    text = call("filters").stdout
    assert max(map(len, text.splitlines())) <= 80
    assert "\n    Simplification: Quadric Edge Collapse Decimation\n" in text


# --- as steps of a script ------------------------------------------------------------------------


def test_every_filter_can_be_printed_as_a_step_without_faults(tmp_path):
    path = tmp_path / "step.mlx"
    wrong = {}
    for name in pymeshlab.filter_list():
        text = call("filters", name, "--mlx").stdout
        path.write_text(text, encoding="utf-8")
        assert len(script.read(path)) == 1
        faults = [*script.check(path), *script.warnings(path)]
        # What is required has no default, and one that is empty is a fault.
        faults = [fault for fault in faults if "can't do without it" not in str(fault)]
        is_wide = [line for line in text.splitlines() if len(line) > 80 and line.count('="') > 1]
        if faults or is_wide:
            wrong[name] = (faults, is_wide)
    assert wrong == {}


def test_printed_step_does_what_the_filter_does_by_itself():
    cube_file()
    text = call("filters", "Willmore flipping optimization", "--mlx").stdout
    assert 'enum_val3="shape"/>\n' in text
    for name in ("selection", "maxdeviation"):
        assert f'<!-- This default depends on the mesh:\n  <Param name="{name}" ' in text
    assert call("run", "-", "-i", "cube.ply", "-o", "step.ply", input=text).exit_code == 0
    call("flip", "cube.ply", "flipped.ply")
    assert same_mesh("step.ply", "flipped.ply")
    assert not same_mesh("step.ply", "cube.ply")


def test_what_depends_on_the_mesh_is_found_for_native_filters_too():
    text = call("filters", "generate_resampled_uniform_mesh", "--mlx").stdout
    assert '<!-- This default depends on the mesh:\n  <Param name="CellSize" ' in text
    assert '\n  <Param name="mergeCloseVert" type="RichBool" value="false"/>\n' in text
    # It is on where faces are selected.
    text = call("filters", "Taubin Smooth", "--mlx").stdout
    assert '<!-- This default depends on the mesh:\n  <Param name="Selected" ' in text


def test_a_step_is_printed_of_one_filter_only():
    result = call("filters", "smooth", "--mlx")
    assert (result.exit_code, result.stdout) == (2, "")
    assert result.stderr.startswith("Error: --mlx needs the whole name of one filter, such as: ")
    assert call("filters", "--mlx").exit_code == 2
