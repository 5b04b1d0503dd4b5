"""A page with a mesh before and after, and the demo's table of stages and pictures."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from .document import page

__all__ = ["page"]


def __getattr__(name: str) -> Any:
    # The table of stages needs no kernels.
    if name == "page":
        from .document import page

        return page
    raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
