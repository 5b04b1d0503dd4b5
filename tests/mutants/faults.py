"""The faults: what becomes of which text, and the tests that must find it."""

from typing import NamedTuple


class Fault(NamedTuple):
    """`old`, which `file` of the package has once, becomes `new`; one of `tests` must fail."""

    name: str
    file: str
    old: str
    new: str
    tests: str


MESH = "tests/mesh/test_halfedge.py tests/mesh/test_build.py"
LOCKS = "tests/guards/test_locks.py"
FOLD = "tests/guards/test_fold.py"
TEXTURE = "tests/guards/test_texture.py"
ANGLES = "tests/energy/test_angles.py"
MEASURE = "tests/test_measure.py"
MORE_ENERGIES = "tests/energy/test_more_energies.py"
READ = "tests/mlx/test_read.py tests/mlx/test_broken.py"
RICH = "tests/mlx/test_rich.py tests/mlx/test_broken_values.py"
CHECK = "tests/meshset/test_check.py"
RECORDING = "tests/meshset/test_recording.py"

CONNECTIVITY = [
    Fault(
        "a new edge may exist already",
        "mesh/halfedge.py",
        "return is_free(mesh, h) and makes_new_edge(mesh, h)",
        "return is_free(mesh, h)",
        MESH,
    ),
    Fault(
        "locks are ignored",
        "mesh/halfedge.py",
        "if t == NONE or mesh.locked[at(h)]:",
        "if t == NONE:",
        MESH,
    ),
    Fault(
        "a vertex may keep two edges",
        "mesh/halfedge.py",
        "return ((k_i != NONE) | (i_l != NONE)) & ((j_k != NONE) | (l_j != NONE))",
        "return True",
        MESH,
    ),
    Fault(
        "corners are those of the other end",
        "mesh/halfedge.py",
        "mesh.corner[at(k_i)] = at_l, at_k, at_i",
        "mesh.corner[at(k_i)] = at_l, at_k, at_j",
        MESH,
    ),
    Fault(
        "outer twins are mixed up",
        "mesh/halfedge.py",
        "_glue(mesh, j_k, outer[1], locks[1])",
        "_glue(mesh, j_k, outer[0], locks[1])",
        MESH,
    ),
    Fault(
        "locks do not move with their edges",
        "mesh/halfedge.py",
        "_glue(mesh, k_i, outer[2], locks[2])",
        "_glue(mesh, k_i, outer[2], locks[1])",
        MESH,
    ),
    Fault(
        "two vertices of several fans are never joined",
        "mesh/halfedge.py",
        "if mesh.several_fans[at(u)] and mesh.several_fans[at(v)]:\n        return True",
        "if mesh.several_fans[at(u)] and mesh.several_fans[at(v)]:\n        return False",
        MESH,
    ),
    Fault(
        "neighbours of opposite orientation are twins",
        "mesh/build.py",
        "if after - start == 2 and origin[at(h)] != origin[at(t)]:",
        "if after - start == 2:",
        MESH,
    ),
    Fault(
        "edges of three faces have twins",
        "mesh/build.py",
        "if after - start == 2 and origin",
        "if after - start >= 2 and origin",
        MESH,
    ),
]

GUARDS = [
    Fault(
        "one unselected face does not lock its edges",
        "guards/locks.py",
        "    if mesh.twin[h] != NONE:\n        mesh.locked[mesh.twin[h]] = True",
        "    if mesh.twin[h] != NONE:\n        mesh.locked[mesh.twin[h]] = False",
        LOCKS,
    ),
    Fault(
        "creases at the limit are free",
        "guards/locks.py",
        "least = max(limit - CREASE_SLACK, CREASE_SLACK)",
        "least = max(limit + CREASE_SLACK, CREASE_SLACK)",
        LOCKS,
    ),
    Fault(
        "a seam is looked for at one end only",
        "guards/locks.py",
        "(_differ(uv, h, following(t)) or _differ(uv, following(h), t))",
        "_differ(uv, h, following(t))",
        TEXTURE,
    ),
    Fault(
        "a face that maps nowhere keeps free sides",
        "guards/locks.py",
        "for side in (h, following(h), previous(h)):",
        "for side in (h,):",
        TEXTURE,
    ),
    Fault(
        "an old crease counts for nothing",
        "guards/fold.py",
        "> max(before, limits.angle) + limits.slack",
        "> limits.angle + limits.slack",
        FOLD,
    ),
    Fault(
        "slivers are made",
        "guards/fold.py",
        "if worse_after >= limits.shape:",
        "if worse_after >= 0.0:",
        FOLD,
    ),
    Fault(
        "a sliver is never flipped away",
        "guards/fold.py",
        "return worse_after < min(triangle_shape(i, j, k), triangle_shape(j, i, l))",
        "return True",
        FOLD,
    ),
    Fault(
        "one texture triangle may be turned over",
        "guards/texture.py",
        "return not (new_one == one and new_other == one)",
        "return not (new_one == one or new_other == one)",
        TEXTURE,
    ),
]

ENERGIES = [
    Fault(
        "half turns are not counted",
        "energy/angles.py",
        "total.half_turns + (1.0 if is_past else 0.0)",
        "total.half_turns",
        ANGLES,
    ),
    Fault(
        "the wrong sign in an angle",
        "energy/angles.py",
        "x = c1 * n2.x + c2 * n1.x - n3.x",
        "x = c1 * n2.x + c2 * n1.x + n3.x",
        ANGLES,
    ),
    Fault(
        "a flat face is infinitely bad",
        "energy/delaunay.py",
        "return FLATTEST, four_areas > 0.0",
        "return FLATTEST, True",
        MORE_ENERGIES + "::test_a_face_without_area_is_flipped_away",
    ),
    Fault(
        "rim vertices have Gaussian curvature",
        "energy/gaussian_curvature.py",
        "if mesh.twin[h] == NONE or mesh.several_fans[mesh.origin[h]]:",
        "if mesh.several_fans[mesh.origin[h]]:",
        MORE_ENERGIES + "::test_only_closed_fans_have_gaussian_curvature",
    ),
    Fault(
        "rim vertices count in the Willmore energy",
        "measure.py",
        "return np.where(defined, sums - FULL_TURN, 0.0)",
        "return sums - FULL_TURN",
        MEASURE,
    ),
    Fault(
        "the area is in other units",
        "measure.py",
        "area=in_input_units(area.total(mesh), 2 * exponent)",
        "area=in_input_units(area.total(mesh), exponent)",
        MEASURE,
    ),
]

FILES = [
    Fault(
        "special files are replaced",
        "files.py",
        "    refuse_special(target)\n",
        "",
        "tests/test_files.py tests/cli/test_saving.py",
    ),
    Fault(
        "a link is replaced, not its file",
        "files.py",
        "return Path(os.path.realpath(path)) if path.is_symlink() else path",
        "return path",
        "tests/test_files.py",
    ),
    Fault(
        "a replaced file loses its mode",
        "files.py",
        "        shutil.copymode(place, source)",
        "        pass",
        "tests/test_files.py",
    ),
    Fault(
        "a pipe that nobody reads from blocks",
        "files.py",
        'getattr(os, "O_NOCTTY", 0) | getattr(os, "O_NONBLOCK", 0)',
        'getattr(os, "O_NOCTTY", 0)',
        "tests/cli/test_runlog.py",
    ),
]

SCRIPTS = [
    Fault(
        "a parameter may be given twice",
        "mlx/read.py",
        "        elif not is_new:\n            self.add(",
        "        elif False:\n            self.add(",
        READ,
    ),
    Fault(
        "text between elements is overlooked",
        "mlx/read.py",
        "not self._has_text and not content.isspace()",
        "not self._has_text and content is None",
        READ,
    ),
    Fault(
        "declarations are read",
        "mlx/read.py",
        "        if self.parser.declares:",
        "        if False:",
        READ,
    ),
    Fault(
        "depth has no end",
        "mlx/read.py",
        "if len(self._open) == DEEPEST:",
        "if len(self._open) == 100 * DEEPEST:",
        READ,
    ),
    Fault(
        "a script is read in one encoding only",
        "mlx/decode.py",
        "encoding = marked or _declared(data)",
        'encoding = marked or "utf-8"',
        READ,
    ),
    Fault(
        "False is false",
        "mlx/rich.py",
        '    if text == "false":\n',
        '    if text.lower() == "false":\n',
        RICH,
    ),
    Fault(
        "a number may be too close to zero",
        "mlx/rich.py",
        "if abs(value) <= SMALLEST_FLOAT and _NOT_ZERO.match(number):",
        "if abs(value) < SMALLEST_FLOAT and _NOT_ZERO.match(number):",
        RICH,
    ),
    Fault(
        "a percentage may be above 100",
        "mlx/rich.py",
        "if not 0 <= percent <= 100:",
        "if not 0 <= percent:",
        RICH,
    ),
    Fault(
        "line breaks are written as they are",
        "mlx/write.py",
        '        "\\n": "&#10;",\n',
        "",
        "tests/mlx/test_write.py",
    ),
    Fault(
        "an enum's choices are those of the script",
        "meshset/check.py",
        "return details if is_there else (*kept, *choices)",
        "return details",
        "tests/cli/test_convert.py",
    ),
]

SETS = [
    Fault(
        "ids are not checked",
        "meshset/check.py",
        "            self._check_id(own, value)\n",
        "",
        CHECK + " tests/test_script.py",
    ),
    Fault(
        "a required parameter may be missing",
        "meshset/check.py",
        "if own.required and own.keyword not in",
        "if False and own.keyword not in",
        CHECK,
    ),
    Fault(
        "deleted meshes are still there",
        "meshset/check.py",
        "        self._left -= known.name == _DELETE\n",
        "",
        CHECK + " tests/test_script.py",
    ),
    Fault(
        "our steps come last in a script",
        "meshset/recording.py",
        "return [*entries, *unnoted] if has_steps else [*unnoted, *entries]",
        "return [*unnoted, *entries]",
        RECORDING,
    ),
    Fault(
        "a script keeps physical ids",
        "meshset/recording.py",
        "    if not ids:\n        return step",
        "    if True:\n        return step",
        RECORDING,
    ),
    Fault(
        "helper layers count",
        "meshset/ids.py",
        "return mesh_id - bisect_left(used, mesh_id)",
        "return mesh_id",
        "tests/meshset/test_ids.py",
    ),
    Fault(
        "held meshes are not noticed",
        "meshset/layers.py",
        "return alone and not _is_held(ms, native.ids(ms)[0])",
        "return alone",
        "tests/meshset/test_parked.py",
    ),
    Fault(
        "selected sides stay where they were",
        "meshset/edge_flags.py",
        "flags[changed] = (flags[changed] & ~mask) | bits",
        "flags[changed] = flags[changed] | bits",
        "tests/meshset/test_exchange.py::test_side_bits_move_with_their_sides",
    ),
    Fault(
        "inner edges of polygons are free",
        "meshset/edge_flags.py",
        "fixed = faux | faux.any(axis=1, keepdims=True)",
        "fixed = faux & False",
        "tests/meshset/test_exchange.py",
    ),
    Fault(
        "what PyMeshLab drops is not noticed",
        "meshset/exchange.py",
        "return [what for what, holds in checks.items() if not holds()]",
        "return []",
        "tests/meshset/test_exchange.py",
    ),
    Fault(
        "texture coordinates are not moved",
        "meshset/exchange.py",
        "wedges[corners.ravel()].reshape(-1, 6)",
        "wedges.reshape(-1, 6)",
        "tests/meshset/test_mappings.py tests/meshset/test_exchange.py",
    ),
]

COMMANDS = [
    Fault(
        "existing outputs are replaced without --force",
        "cli/paths.py",
        "if os.path.lexists(path) and not force:",
        "if False:",
        "tests/cli/test_run.py tests/cli/test_saving.py",
    ),
    Fault(
        "two outputs may have one name",
        "cli/paths.py",
        "            if key in writers:",
        "            if False:",
        "tests/cli/test_run.py",
    ),
    Fault(
        "an input may be replaced by the result of another",
        "cli/paths.py",
        "if readers.get(key, source) != source:",
        "if False:",
        "tests/cli/test_run.py",
    ),
    Fault(
        "a bad input ends a batch",
        "cli/paths.py",
        "            index += not isinstance(problem, NoMatchError)\n",
        "            if problem:\n                raise problem\n",
        "tests/cli/test_loading.py",
    ),
    Fault(
        "a full disk is not noticed",
        "cli/saving.py",
        "            file.write(bytes(_ROOM))",
        "            pass",
        "tests/cli/test_saving.py",
    ),
    Fault(
        "after an error new files stay",
        "cli/saving.py",
        "                file.unlink(missing_ok=True)",
        "                pass",
        "tests/cli/test_saving.py",
    ),
    Fault(
        "the exit code of a signal is 1",
        "cli/errors.py",
        "ctx.exit(SIGNAL_EXIT + caught[0])",
        "ctx.exit(1)",
        "tests/cli/test_errors.py",
    ),
    Fault(
        "a log may be written over anything",
        "cli/runlog.py",
        "    if beginning and not _BEGINNING.match(beginning):",
        "    if False:",
        "tests/cli/test_runlog.py",
    ),
    Fault(
        "names are measured by letters",
        "cli/text.py",
        'return 2 if unicodedata.east_asian_width(letter) in "WF" else 1',
        "return 1",
        "tests/cli/test_text.py tests/cli/test_progress.py",
    ),
    Fault(
        "JSON has numbers that are none",
        "cli/text.py",
        "None if isinstance(value, float) and not math.isfinite(value) else value",
        "value",
        "tests/cli/test_measure.py tests/cli/test_compare.py",
    ),
]

FAULTS = [*CONNECTIVITY, *GUARDS, *ENERGIES, *FILES, *SCRIPTS, *SETS, *COMMANDS]
