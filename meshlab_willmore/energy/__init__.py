"""What is minimised: the Willmore energy with and without virtual points, areas, curvatures.

An energy is a module with two jitted functions of the same signature for all:
``cost_reduction(mesh, h) -> float`` (positive: the flip of `h` helps) and ``total(mesh) -> float``.
`meshlab_willmore.energy.table` has a row for each.
"""
