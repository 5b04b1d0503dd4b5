"""Many meshes: isolated from each other, resumable, on all cores and on a cluster.

Each mesh is processed in a worker process that may crash, hang or run out of memory::

    from meshlab_willmore import batch

    for result in batch.run("clean.mlx", "scans/**/*.ply", "out/{dir}/{name}.ply", timeout=60):
        print(result.input, result.status, result.reason)
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from .records import Result
    from .runner import run

__all__ = ["Result", "run"]


def __getattr__(name: str) -> Any:
    # The command line reads names of this room before it needs PyMeshLab.
    if name == "run":
        from .runner import run

        return run
    if name == "Result":
        from .records import Result

        return Result
    raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
