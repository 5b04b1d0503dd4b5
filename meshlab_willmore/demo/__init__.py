"""The paper's three experiments, run with PyMeshLab.

`models` and `scan` make the meshes, `experiments` applies the filters, and `recorder` measures and
saves the results.
"""
