"""What is minimised: the Willmore energy with and without virtual points, areas, curvatures.

An energy is a module, and a row of `meshlab_willmore.energy.table`. Its jitted functions are

``cost_reduction(mesh, h) -> float``
    By how much the energy drops when `h`, a half-edge with a twin, is flipped: positive where the
    flip helps. Minus infinity where the energy has no value before or after (corners of the diamond
    coincide, or an angle is undefined), so never NaN. For energies in lengths, and "delaunay", 0
    where the difference is made of rounding. It depends on the two faces at `h` and on the four
    around them; if the energy is wide, on all faces at the four corners. An energy whose virtual
    points can be anywhere takes their place as a third argument.
``total(mesh) -> float``
    The energy of the mesh, in the same unit. Where the cost reduction is no difference of an
    energy, the one that it is meant to lower.
``drop(quad, wings) -> AngleSum``, if it is a sum of angles
    Half of the cost reduction, from the points around the edge alone and without a branch. With it
    `meshlab_willmore.search.scoring` scores many edges at once.
``quick_reduction(quad, wings) -> float``, if plain arithmetic is mostly enough
    The cost reduction in that way, bit for bit; not finite where `cost_reduction` looks closer. It
    serves the same purpose.
"""
