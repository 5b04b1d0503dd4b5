"""Random meshes and options for `optimize_flips`, and all that it promises, checked after each run.

    python -m tests.fuzz --seed 1 --count 1000
    python -m tests.fuzz --seed 1 --case 17

The checks are plain Python and NumPy, and know nothing of the package's half-edges.
"""
