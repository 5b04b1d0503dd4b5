"""Many meshes: isolated from each other, resumable, on all cores and on a cluster."""
