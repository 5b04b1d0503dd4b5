"""Meshes with all that a mesh can have, or little of it, and what PyMeshLab tells of them."""

import numpy as np
import pymeshlab

from meshlab_willmore.meshset import ply
from meshlab_willmore.meshset.snapshot import take
from tests import meshes
from tests.meshset.conftest import random_transform, set_of
from tests.test_mapping import distorted

ATTRIBUTES = ["My Attr", "x", "w"]


def rich_set():
    """A mesh with all that `pymeshlab.Mesh` and `MeshSet` can put on one."""
    vertices, faces = meshes.bumpy_sphere(300)
    n, m = len(vertices), len(faces)
    rng = np.random.default_rng(7)
    ms = set_of(
        vertices,
        faces,
        edge_matrix=np.array([[0, 5], [9, 2]]),
        v_scalar_array=rng.normal(size=n),
        f_scalar_array=rng.normal(size=m),
        v_color_matrix=rng.random((n, 4)),
        f_color_matrix=rng.random((m, 4)),
        v_tex_coords_matrix=rng.random((n, 2)),
    )
    ms.compute_selection_by_condition_per_face(condselect="fi > 99")
    ms.compute_selection_by_condition_per_vertex(condselect="vi < 99")
    ms.set_matrix(transformmatrix=random_transform(), freeze=False)
    ms.current_mesh().set_label("a label.with ümlaut")
    ms.set_current_mesh_visibility(False)
    mesh = ms.current_mesh()
    for name in ATTRIBUTES:
        mesh.add_vertex_custom_scalar_attribute(rng.normal(size=n), name)
        mesh.add_vertex_custom_point_attribute(rng.normal(size=(n, 3)), name + "P")
        mesh.add_face_custom_scalar_attribute(rng.normal(size=m), name + "-f")
        mesh.add_face_custom_point_attribute(rng.normal(size=(m, 3)), name + ".F")
    return ms


STATE = (
    "vertex_matrix",
    "edge_matrix",
    "vertex_color_array",
    "vertex_scalar_array",
    "vertex_tex_coord_matrix",
    "vertex_selection_array",
    "face_color_array",
    "face_scalar_array",
    "face_selection_array",
    "transform_matrix",
    "label",
    "is_visible",
    "has_vertex_color",
    "has_vertex_scalar",
    "has_vertex_tex_coord",
    "has_face_color",
    "has_face_scalar",
    "has_wedge_tex_coord",
    "texture_number",
    "vertex_number",
    "face_number",
    "edge_number",
    "is_compact",
)
NEEDS = {
    "vertex_color_array": "has_vertex_color",
    "vertex_scalar_array": "has_vertex_scalar",
    "vertex_tex_coord_matrix": "has_vertex_tex_coord",
    "face_color_array": "has_face_color",
    "face_scalar_array": "has_face_scalar",
}


def state(ms):
    """All that PyMeshLab can tell of the current mesh, but for faces, wedges and normals."""
    mesh = ms.current_mesh()
    shown = {"texture names": sorted(mesh.textures())}
    for name in STATE:
        if name not in NEEDS or getattr(mesh, NEEDS[name])():
            shown[name] = getattr(mesh, name)()
    shown["attributes"] = sorted(ms.filter_parameter_values("ply"))
    return shown


def assert_same_state(left, right):
    assert left.keys() == right.keys()
    for name in left:
        np.testing.assert_array_equal(left[name], right[name], err_msg=name)


def quad_set(height=0.4):
    """A bumpy grid, quads on the left, triangles on the right."""
    vertices, faces = meshes.grid(8, 8)
    rng = np.random.default_rng(1)
    vertices = vertices + np.column_stack([np.zeros((81, 2)), height * rng.random(81)])
    polygons = []
    for two in faces.reshape(-1, 2, 3):
        (a, b, c), (_, _, d) = two
        left = vertices[a, 0] < 4
        polygons += [np.array([a, b, c, d])] if left else [np.array(t) for t in two]
    ms = pymeshlab.MeshSet()
    ms.add_mesh(pymeshlab.Mesh(vertex_matrix=vertices, face_list_of_indices=polygons), "quads")
    return ms


def plain_set(tmp_path, radius=False, edges=()):
    """A mesh from a file that has positions and faces, and what else is asked for."""
    vertices, faces = meshes.bumpy_sphere(300)
    more = [("radius", "<f4")] if radius else []
    points = np.zeros(len(vertices), [(axis, "<f8") for axis in "xyz"] + more)
    for n, axis in enumerate("xyz"):
        points[axis] = vertices[:, n]
    if radius:
        points["radius"] = np.arange(len(vertices)) / 7
    triangles = np.zeros(
        len(faces), [("vertex_indices_count", "u1"), ("vertex_indices", "<i4", (3,))]
    )
    triangles["vertex_indices_count"] = 3
    triangles["vertex_indices"] = faces
    edges = np.array(edges, np.int32).reshape(-1, 2)
    ply.write(tmp_path / "plain.ply", ply.PlyMesh(points, triangles, edges, ()))
    ms = pymeshlab.MeshSet()
    ms.load_new_mesh(str(tmp_path / "plain.ply"))
    return ms


def seams_of(ms):
    """Edges whose two faces have other texture coordinates at an end, or another texture."""
    records = take(ms).ply.faces
    if "texcoord" not in records.dtype.names:
        return set()
    count = len(records)
    number = records["texnumber"] if "texnumber" in records.dtype.names else np.zeros(count, int)
    rows = zip(
        records["vertex_indices"].tolist(),
        records["texcoord"].reshape(-1, 3, 2).tolist(),
        number.tolist(),
        strict=True,
    )
    sides = {}
    for face, corners, texture in rows:
        for c in range(3):
            ends = {face[c]: tuple(corners[c]), face[c - 2]: tuple(corners[c - 2])}
            sides.setdefault(frozenset(ends), []).append((ends, texture))
    return {edge for edge, (one, *others) in sides.items() if any(one != o for o in others)}


def surface(seed):
    """A bumpy grid, and a mapping of it to a plane."""
    vertices, faces = meshes.grid(8, 8)
    vertices[:, 2] = 0.6 * np.random.default_rng(1).random(len(vertices))
    uv = vertices[:, :2].copy()
    distorted(vertices, faces, uv, seed)
    return vertices, faces, uv
