"""Faults of connectivity, guards, energies, searches and their options."""

from . import Fault

MESH = "tests/mesh/test_halfedge.py tests/mesh/test_build.py"
LOCKS = "tests/guards/test_locks.py"
FOLD = "tests/guards/test_fold.py"
TEXTURE = "tests/guards/test_texture.py"
ANGLES = "tests/energy/test_angles.py"
MEASURE = "tests/test_measure.py"
MORE_ENERGIES = "tests/energy/test_more_energies.py"

CONNECTIVITY = [
    Fault(
        "a new edge may exist already",
        "mesh/halfedge.py",
        "return apex(mesh, h) != apex(mesh, t) and not are_joined(mesh, previous(h), previous(t))",
        "return apex(mesh, h) != apex(mesh, t)",
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

SEARCHES = [
    Fault(
        "a search may make an edge twice",
        "search/rules.py",
        "return ALLOWED if makes_new_edge(mesh, h) else EXISTS",
        "return ALLOWED",
        "tests/search/test_greedy.py::test_the_cycle_on_a_random_torus_ends "
        "tests/search/test_parallel_greedy.py::"
        "test_of_two_flips_to_the_same_edge_the_smaller_waits_until_it_is_gone",
    ),
    Fault(
        "one flip too many",
        "search/greedy.py",
        "        if flips == rules.maxflips:",
        "        if flips > rules.maxflips:",
        "tests/search/test_greedy.py::test_maxflips_stops_on_the_way",
    ),
    Fault(
        "edges that wait for an edge to go are forgotten",
        "search/greedy.py",
        "    visit_freed(found, h, stencil.append, None)\n",
        "",
        "tests/search/test_greedy.py::test_an_edge_freed_by_a_flip_elsewhere_is_flipped_too",
    ),
    Fault(
        "edges that watch a face are too many for the room",
        "search/greedy.py",
        "        if count == len(state.edges):\n",
        "        if count == len(state.edges) + 1:\n",
        "tests/search/test_greedy.py::test_more_edges_than_are_scored_at_a_time_may_watch_a_face",
    ),
    Fault(
        "equal priorities come out in any order",
        "search/containers.py",
        "priority > other_priority or (priority == other_priority and item < other_item)",
        "priority > other_priority",
        "tests/search/test_containers.py",
    ),
    Fault(
        "an edge is queued twice",
        "search/containers.py",
        "    if not fifo.is_queued[h]:",
        "    if True:",
        "tests/search/test_containers.py",
    ),
    Fault(
        "pairs of vertices have a direction",
        "search/containers.py",
        "low, high = np.int64(min(a, b)), np.int64(max(a, b))",
        "low, high = np.int64(a), np.int64(b)",
        "tests/search/test_containers.py",
    ),
    Fault(
        "an edge watches several faces",
        "search/containers.py",
        "    unwatch(lists, h)\n    following = ",
        "    following = ",
        "tests/search/test_containers.py",
    ),
    Fault(
        "the stencil lacks a side",
        "search/stencil.py",
        "for side in (following(h), previous(h), following(t), previous(t)):",
        "for side in (following(h), previous(h), following(t)):",
        "tests/search/test_variable_depth.py::test_the_ring_is_where_cost_reductions_change",
    ),
    Fault(
        "a virtual point may be at an end",
        "options.py",
        "if not 0.0 < part < 1.0:",
        "if not 0.0 <= part <= 1.0:",
        "tests/test_options.py",
    ),
    Fault(
        "a filter's integers have no upper limit",
        "options.py",
        "not option.least <= number <= option.most:",
        "not option.least <= number:",
        "tests/test_options.py",
    ),
]

FAULTS = [*CONNECTIVITY, *GUARDS, *ENERGIES, *SEARCHES]
