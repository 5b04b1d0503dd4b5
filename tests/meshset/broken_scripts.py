"""Scripts that read well, each with one fault, and what is said of it."""

from typing import NamedTuple

from meshlab_willmore.options import ENERGY
from tests.meshset.scripts import (
    FLIP_NAME,
    HAUSDORFF,
    MATRIX,
    REMESH,
    TAUBIN,
    energy,
    old_step,
    param,
    percentage,
    step,
)

ENERGIES = ", ".join(f"{i} {name!r}" for i, name in enumerate(ENERGY.choices))
NO_ENERGY = len(ENERGY.choices)
REMESH_PARAMS = (
    "Iterations, Adaptive, SelectedOnly, TargetLen, FeatureDeg, CheckSurfDist, MaxSurfDist, "
    "SplitFlag, CollapseFlag, SwapFlag, SmoothFlag, ReprojectFlag"
)
MISTYPED = "is given as {}, but is a {}: PyMeshLab would read {}; write type='{}'"
NEEDS_MESH = "needs a mesh; give an input, or begin with a filter that creates one"


class Broken(NamedTuple):
    """A script with one fault, and all that is said of it."""

    said: str
    steps: tuple[str, ...]
    mesh_ids: tuple[int, ...] | None = None


def broken(said, *steps, ids=None):
    return Broken(said, steps, ids)


CORPUS = [
    # filters
    broken(
        "step 1 (Taubin Smoth): no such filter; did you mean 'Taubin Smooth' or "
        "'Laplacian Smooth' or 'Depth Smooth'?",
        step("Taubin Smoth"),
    ),
    broken(
        "step 2 (taubin smooth): no such filter; did you mean 'Taubin Smooth'? "
        "Upper and lower case differ",
        step(TAUBIN),
        step("taubin smooth"),
    ),
    broken(
        "step 1 (Willmore Flipping Optimization): no such filter; did you mean "
        "'Willmore flipping optimization'? Upper and lower case differ",
        step("Willmore Flipping Optimization"),
    ),
    broken(
        "step 1 (get_willmore_measure): no such filter; did you mean 'get_willmore_measures' or "
        "'get_geometric_measures' or 'get_topological_measures'?",
        step("get_willmore_measure"),
    ),
    broken(
        "step 1 (qqqqq): no such filter; pymeshlab.print_filter_list() lists them", step("qqqqq")
    ),
    # names of parameters
    broken(
        f"step 1 ({REMESH}), parameter 'Targetlen': no such parameter; did you mean 'TargetLen'? "
        "Upper and lower case differ",
        step(REMESH, percentage("Targetlen", 1)),
    ),
    broken(
        f"step 1 ({REMESH}), parameter 'TargetLength': no such parameter; did you mean "
        "'TargetLen'?",
        step(REMESH, percentage("TargetLength", 1)),
    ),
    broken(
        f"step 1 ({REMESH}), parameter 'zzz': no such parameter; it has {REMESH_PARAMS}",
        step(REMESH, percentage("zzz", 1)),
    ),
    broken(
        "step 1 (Planar flipping optimization), parameter 'qqq': no such parameter; it has "
        "selection, pthreshold, planartype, iterations",
        step("Planar flipping optimization", param("qqq", "RichInt", value=1)),
    ),
    broken(
        "step 1 (Re-Compute Face Normals), parameter 'selection': no such parameter; the filter "
        "has none",
        step("Re-Compute Face Normals", param("selection", "RichBool", value="true")),
    ),
    broken(
        f"step 1 ({REMESH}), parameter 'targetlen': is given twice, also as 'TargetLen'",
        step(REMESH, percentage("TargetLen", 1), percentage("targetlen", 1)),
    ),
    broken(
        f"step 1 ({REMESH}), parameter 'TargetLen': is given twice, also as 'targetlen'",
        step(REMESH, percentage("targetlen", 1), percentage("TargetLen", 1)),
    ),
    broken(
        f"step 1 ({FLIP_NAME}), parameter 'maxFlips': no such parameter; did you mean "
        "'maxflips'? Upper and lower case differ",
        step(FLIP_NAME, param("maxFlips", "RichInt", value=1)),
    ),
    # types
    *(
        broken(
            f"step 1 ({REMESH}), parameter '{name}': is given as {given}, but is a {own}: "
            f"PyMeshLab would read {read}; write type='{own}'",
            step(REMESH, param(name, given, value=value)),
        )
        for name, given, value, own, read in (
            ("FeatureDeg", "RichInt", 30, "RichFloat", "zero"),
            ("Iterations", "RichFloat", 3, "RichInt", "zero"),
            ("Adaptive", "RichInt", 1, "RichBool", "false"),
        )
    ),
    broken(
        f"step 1 ({FLIP_NAME}), parameter 'foldangle': is given as RichString, but is a "
        "RichFloat: PyMeshLab would read zero; write type='RichFloat'",
        step(FLIP_NAME, param("foldangle", "RichString", value="90")),
    ),
    broken(
        "step 1 (Set Texture), parameter 'textName': is given as RichBool, but is a RichOpenFile: "
        "PyMeshLab would read ''; write type='RichOpenFile'",
        step("Set Texture", param("textName", "RichBool", value="true")),
    ),
    broken(
        f"step 1 ({FLIP_NAME}), parameter 'energy': is given as RichString, but is a RichEnum: "
        "PyMeshLab would read zero; write type='RichEnum'",
        step(FLIP_NAME, param("energy", "RichString", value="willmore")),
    ),
    # values
    broken(
        f"step 1 ({REMESH}), parameter 'FeatureDeg': can't be a percentage: a RichFloat has no "
        "range; give a number",
        step(REMESH, percentage("FeatureDeg", "5%")),
    ),
    broken(
        f"step 1 ({TAUBIN}), parameter 'lambda': 'half' is not a number",
        old_step(TAUBIN, **{"lambda": "half"}),
    ),
    broken(
        f"step 1 ({TAUBIN}), parameter 'stepSmoothNum': '2.5' is not a whole number",
        old_step(TAUBIN, stepSmoothNum="2.5"),
    ),
    broken(
        f"step 1 ({TAUBIN}), parameter 'Selected': 'yes' is neither 'true' nor 'false'",
        old_step(TAUBIN, Selected="yes"),
    ),
    broken(
        f"step 1 ({MATRIX}), parameter 'TransformMatrix': '1 0 0 1' is not 16 numbers",
        old_step(MATRIX, TransformMatrix="1 0 0 1"),
    ),
    broken(
        "step 1 (Set Mesh Camera), parameter 'Shot': a RichShotf can't be given as text",
        old_step("Set Mesh Camera", Shot="1 2 3"),
    ),
    # choices
    broken(
        f"step 1 ({FLIP_NAME}), parameter 'energy': there is no choice {NO_ENERGY}; "
        f"the choices are {ENERGIES}",
        step(FLIP_NAME, energy(NO_ENERGY)),
    ),
    broken(
        "step 1 (Planar flipping optimization), parameter 'planartype': there is no choice 5; the "
        "choices are 0 'area/max side', 1 'inradius/circumradius', 2 'mean ratio', "
        "3 'delaunay', 4 'topology'",
        step(
            "Planar flipping optimization",
            param("planartype", "RichInt", value=5),
        ),
    ),
    broken(
        f"step 1 ({FLIP_NAME}), parameter 'energy': choice 0 is 'virtual willmore', but the "
        "script says 'willmore', which is 1",
        step(FLIP_NAME, energy(0, "willmore", "virtual willmore")),
    ),
    broken(
        f"step 1 ({FLIP_NAME}), parameter 'energy': there is no choice 'volume'; the choices are "
        f"{ENERGIES}",
        old_step(FLIP_NAME, energy="volume"),
    ),
    # ranges of ours
    broken(
        f"step 1 ({FLIP_NAME}), parameter 'foldangle': foldangle must lie in 0 .. 180 degrees, "
        "not 181.0",
        step(FLIP_NAME, param("foldangle", "RichFloat", value=181)),
    ),
    broken(
        f"step 1 ({FLIP_NAME}), parameter 'featuredeg': featuredeg must lie in 0 .. 180 degrees, "
        "not -1.0",
        step(FLIP_NAME, param("featuredeg", "RichFloat", value=-1)),
    ),
    broken(
        f"step 1 ({FLIP_NAME}), parameter 'maxflips': maxflips must be -1 (no limit) or more, it "
        "is -2",
        step(FLIP_NAME, param("maxflips", "RichInt", value=-2)),
    ),
    # what is required
    broken(
        "step 1 (Import cameras for active rasters from file), parameter 'ImportFile': is "
        "missing; the filter can't do without it",
        step("Import cameras for active rasters from file"),
    ),
    broken(
        "step 1 (Import cameras for active rasters from file), parameter 'ImportFile': is "
        "empty; the filter can't do without it",
        old_step("Import cameras for active rasters from file", ImportFile=""),
    ),
    # meshes
    broken(
        f"step 1 ({HAUSDORFF}), parameter 'SampledMesh': there will be no mesh 2 (there are: 0, 1)",
        step(HAUSDORFF, param("SampledMesh", "RichMesh", value=2)),
        ids=(1, 0),
    ),
    broken(
        f"step 2 ({HAUSDORFF}), parameter 'TargetMesh': there will be no mesh 1 "
        "(there are: 0, 3; new ones get higher ids)",
        step("Box/Cube"),
        step(HAUSDORFF, param("TargetMesh", "RichMesh", value=1)),
        ids=(0, 3),
    ),
    broken(
        f"step 2 ({HAUSDORFF}), parameter 'TargetMesh': there will be no mesh 1 (there are: 0)",
        step(FLIP_NAME),
        step(HAUSDORFF, param("TargetMesh", "RichInt", value=1)),
        ids=(0,),
    ),
    # Later steps need one too: that is no news.
    broken(f"step 1 ({FLIP_NAME}): {NEEDS_MESH}", step(FLIP_NAME), step(TAUBIN), ids=()),
    broken(
        f"step 1 ({TAUBIN}): {NEEDS_MESH}",
        step(TAUBIN),
        step("Box/Cube"),
        step(HAUSDORFF, param("TargetMesh", "RichMesh", value=7)),
        ids=(),
    ),
]
