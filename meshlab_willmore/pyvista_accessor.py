"""PyVista: ``mesh.willmore`` flips and measures a mesh.

PyVista 0.48 or later finds this module by its entry point ``pyvista.accessors`` when
``mesh.willmore`` is first used, so nothing is to be imported. With an older PyVista
``WillmoreAccessor(mesh)`` does the same, but a flipped mesh has no `result`.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
import pyvista
from numpy.typing import NDArray

from .measure import Measures, measures, vertex_willmore_energy
from .optimize import optimize_flips
from .results import FlipResult

if TYPE_CHECKING:
    from typing_extensions import Unpack

    from .options import FlipOptions


class WillmoreAccessor:
    """Willmore-energy edge flips and measures of a PyVista surface.

    Parameters
    ----------
    mesh : pyvista.PolyData
        It must consist of triangles; vertices and lines beside them are left alone.

    Attributes
    ----------
    result : FlipResult or None
        Of a mesh that `flip` returned: what the flips did. None for other meshes.

    Examples
    --------
    >>> import pyvista
    >>> mesh = pyvista.Sphere()
    >>> flipped = mesh.willmore.flip(preset="faithful")  # doctest: +SKIP
    >>> flipped.willmore.result.flips  # doctest: +SKIP
    """

    def __init__(self, mesh: pyvista.PolyData) -> None:
        self._mesh = mesh
        self.result: FlipResult | None = None

    def flip(self, **options: Unpack[FlipOptions]) -> pyvista.PolyData:
        """Flip edges, and return the flipped mesh as a new one.

        Parameters
        ----------
        **options
            As those of `meshlab_willmore.optimize_flips`: ``preset="faithful"``,
            ``energy="mean curvature"``, ``featuredeg=30`` and so on. Where the points have texture
            coordinates, no flip inverts a texture triangle or makes it flat, unless `wedge_uv` is
            given.

        Returns
        -------
        pyvista.PolyData
            A copy with other faces; ``flipped.willmore.result`` says what was done. Points and
            their data are the same. Cell data stay where they are: a flip replaces the two faces at
            an edge by the two at its other diagonal, which take the same two places, and so the
            data of these; faces at no flipped edge keep theirs. Active normals of points and cells
            are computed anew, as they follow the faces. Points that coincide are a boundary, whose
            edges are kept; ``mesh.clean()`` merges them.

        Raises
        ------
        ValueError
            If a face is not a triangle, or as `meshlab_willmore.optimize_flips`.
        TypeError
            As `meshlab_willmore.optimize_flips`.
        """
        faces = self._triangles()
        texture = self._mesh.active_texture_coordinates
        if texture is not None and options.get("wedge_uv") is None:
            options["wedge_uv"] = np.asarray(texture)[faces]
        result = optimize_flips(self._mesh.points, faces, **options)
        flipped = self._mesh.copy()
        if result.flips:
            flipped.regular_faces = result.faces.astype(np.int64)
            _renew_normals(flipped)
        if _IS_REGISTERED:
            flipped.willmore.result = result
        return flipped

    def energy(self) -> NDArray[np.float64]:
        """Return the Willmore energy of each point.

        Returns
        -------
        (n,) float64
            As `meshlab_willmore.vertex_willmore_energy`: 0 where the point is convex and lies with
            its neighbours on a sphere or plane, and on the boundary.

        Raises
        ------
        ValueError
            If a face is not a triangle.

        Examples
        --------
        >>> mesh["W"] = mesh.willmore.energy()  # doctest: +SKIP
        """
        return vertex_willmore_energy(self._mesh.points, self._triangles())

    def measures(self) -> Measures:
        """Return area, curvatures and Willmore energy of the whole surface.

        Returns
        -------
        Measures
            As `meshlab_willmore.measures`.

        Raises
        ------
        ValueError
            If a face is not a triangle.
        """
        return measures(self._mesh.points, self._triangles())

    def _triangles(self) -> NDArray[np.int64]:
        """The faces (m, 3), or an error."""
        # Each face is the number of its corners, and these.
        listed = np.asarray(self._mesh.faces)
        is_triangular = len(listed) % 4 == 0 and (listed[::4] == 3).all()
        if self._mesh.n_strips or not is_triangular:
            raise ValueError(
                "the mesh has faces that are not triangles; make triangles of them first: "
                "mesh.triangulate().willmore"
            )
        return listed.reshape(-1, 4)[:, 1:]


def _renew_normals(mesh: pyvista.PolyData) -> None:
    """Compute active normals anew, under their own names, for the faces that `mesh` has now."""
    of_points, of_cells = mesh.point_data, mesh.cell_data
    point_name, cell_name = of_points.active_normals_name, of_cells.active_normals_name
    if point_name is None and cell_name is None:
        return
    bare = pyvista.PolyData.from_regular_faces(mesh.points, mesh.regular_faces).compute_normals(
        consistent_normals=False, auto_orient_normals=False, split_vertices=False
    )
    if point_name is not None:
        of_points[point_name] = bare.point_data["Normals"]
    if cell_name is not None:
        # Cells that are no faces come first.
        normals = np.array(of_cells[cell_name])
        normals[len(normals) - bare.n_cells :] = bare.cell_data["Normals"]
        of_cells[cell_name] = normals


_IS_REGISTERED = hasattr(pyvista, "register_dataset_accessor")
if _IS_REGISTERED:
    pyvista.register_dataset_accessor("willmore", pyvista.PolyData)(WillmoreAccessor)
