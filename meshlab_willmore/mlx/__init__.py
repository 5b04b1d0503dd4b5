"""Filter scripts (`.mlx`) as data: read and written without PyMeshLab."""
