"""What `meshlab_willmore.optimize_flips` returns."""

from html import escape
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from . import thumbnail

# The pictures of a result in a notebook, in pixels, and how many faces are drawn twice at most.
PICTURE = (320, 240)
MOST_FACES_IN_BOTH = 300_000


class PassResult(NamedTuple):
    """What one pass of `optimize_flips` did.

    Attributes
    ----------
    energy, search : str
        What it lowered, and how.
    flips : int
        Number of flips; with "annealing" random ones, those that went back and forth included.
    gain : float
        How much this energy fell, as in a `FlipResult` of one pass.
    converged : bool
        Whether no allowed flip lowered this energy any more.
    """

    energy: str
    search: str
    flips: int
    gain: float
    converged: bool


class FlipResult(NamedTuple):
    """Result of `optimize_flips`.

    Attributes
    ----------
    faces : (m, 3) int32
        The new faces, in the slots of the old ones.
    flips : int
        Number of flips, without those that the search took back. With "annealing", whose random
        flips go back and forth, the number of edges that the input did not have.
    gain : float
        With several passes, how much the Willmore energy fell; else how much the chosen energy
        fell, in its unit: radians; the unit of the coordinates times
        radians for "mean curvature", its square for "area", none for "delaunay". The energy
        "virtual willmore" is not a function of the mesh. For it, the gain is the sum of the cost
        reductions with the greedy searches, and with the other searches the drop of the Willmore
        energy, in the form that counts every interior edge.
    willmore_before, willmore_after : float
        Willmore energy of the mesh, as `meshlab_willmore.measure.willmore_energy` returns it:
        summed over interior vertices. The flips lower twice the sum of the intersection angles over
        all interior edges. On a closed mesh the two differ by a constant. With a boundary, the
        Willmore energy leaves out the share of the edges at boundary vertices, and can rise.
    converged : bool
        Whether no allowed flip lowers the energy any more (with "variable depth": none of the
        chains of flips that `meshlab_willmore.search.variable_depth` tries), in each pass when it
        ended. Flips are forbidden by the connectivity, by locks and guards and, with "virtual
        willmore", by the option `monotone`: if True, flips that raise the Willmore energy, if
        False, flips to an edge that was flipped away before. So other flips may be left that lower
        the energy. A second run from the result makes no flip, except: with `monotone` False; with
        "annealing" and "thorough", which may find more; with "variable depth" where flips tie or
        `maxflips` came first, as the way along another energy, which it tries too, may then end
        lower; with `featuredeg` and `maxdeviation`, as creases are found in the input, and
        deviations are counted from it; with several passes, as each undoes flips of another; and
        where flips that keep the Willmore energy go in circles, which the search stops after ten
        rounds.
    reason : str
        Why it stopped.
    corners : (m, 3) int32
        For each corner of the new faces a corner ``3 f + c`` of the old ones at the same vertex and
        on the same side of all locked edges. So ``wedge_data.reshape(3 * m, -1)[corners]`` carries
        data of the old corners over.
    deviation : float
        No point of the result is farther than this from the input, and no point of the input from
        the result, in units of the coordinates: an upper bound of the Hausdorff distance, of which
        `meshlab_willmore.guards.deviation` has the proof.
    absolute_mean_curvature_before, absolute_mean_curvature_after : float
        Sum of dihedral angle times length over the interior edges, in units of the coordinates
        times radians.
    mean_shape_before, mean_shape_after, worst_shape_before, worst_shape_after : float
        Mean and least of the shapes of all triangles: 1 if equilateral, 0 without area.
    passes : tuple of PassResult
        What each pass did, in order.
    vertices : (n, 3) float64
        The vertices, which have not moved. May share memory with the input.
    faces_before : (m, 3) int32
        The faces of the input. May share memory with it.
    """

    faces: NDArray[np.int32]
    flips: int
    gain: float
    willmore_before: float
    willmore_after: float
    converged: bool
    reason: str
    corners: NDArray[np.int32]
    deviation: float
    absolute_mean_curvature_before: float
    absolute_mean_curvature_after: float
    mean_shape_before: float
    mean_shape_after: float
    worst_shape_before: float
    worst_shape_after: float
    passes: tuple[PassResult, ...]
    vertices: np.ndarray
    faces_before: np.ndarray

    def _repr_html_(self) -> str:
        """The result as notebooks show it: a table, and pictures of the mesh before and after."""
        rows = (
            ("Willmore energy W", self.willmore_before, self.willmore_after),
            (
                "Absolute mean curvature M",
                self.absolute_mean_curvature_before,
                self.absolute_mean_curvature_after,
            ),
            ("Mean shape", self.mean_shape_before, self.mean_shape_after),
            ("Worst shape", self.worst_shape_before, self.worst_shape_after),
        )
        cells = "".join(
            f"<tr><th>{name}</th><td>{before:.6g}</td><td>{after:.6g}</td></tr>"
            for name, before, after in rows
        )
        done = ", ".join(f"{one.energy} by {one.search}" for one in self.passes)
        return (
            '<div style="max-width: 100%; overflow-x: auto">'
            f"<p><b>{self.flips:,} flips made</b> of {len(self.faces):,} faces: {escape(done)}; "
            f"{escape(self.reason)}.</p>"
            "<table><thead><tr><th></th><th>before</th><th>after</th></tr></thead>"
            f"<tbody>{cells}<tr><th></th>{self._pictures()}</tr></tbody></table></div>"
        )

    def _pictures(self) -> str:
        """A cell of a table for each picture; of large meshes only of the result."""
        view = thumbnail.view_of(self.vertices, self.faces)
        cells = []
        for name, faces in (("before", self.faces_before), ("after", self.faces)):
            png = b""
            if name == "after" or len(faces) <= MOST_FACES_IN_BOTH:
                png = thumbnail.picture(self.vertices, faces, *PICTURE, view)
            image = f'<img src="{thumbnail.data_uri(png)}" alt="The mesh {name}, shaded">'
            cells.append(f"<td>{image if png else ''}</td>")
        return "".join(cells)
