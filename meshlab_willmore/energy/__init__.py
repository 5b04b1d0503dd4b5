"""What is minimised: intersection angles, the Willmore energy and the virtual Willmore energy.

An energy is a module with two jitted functions of the same signature for all:
``cost_reduction(mesh, h) -> float`` (positive: the flip of `h` helps) and ``total(mesh) -> float``.
"""
