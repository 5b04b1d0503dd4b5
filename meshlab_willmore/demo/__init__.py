"""The paper's three experiments, run inside a real PyMeshLab chain.

`models` and `scan` make the meshes, `story` sends them through the filters, and
`studio` keeps what comes out.
"""
