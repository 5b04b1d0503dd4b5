"""Everything that knows PyMeshLab; no other room imports it."""
