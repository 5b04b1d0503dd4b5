"""Entry point of the command line, as `meshlab-willmore` and as `python -m meshlab_willmore`."""

from __future__ import annotations

import os
import sys


def run() -> None:
    """Run the command line, in UTF-8."""
    _leave_the_c_locale()
    from .cli import main

    main(prog_name="meshlab-willmore")


def _leave_the_c_locale() -> None:
    """Start again in UTF-8 if ``LC_ALL`` names the C locale, as in batch systems.

    There PyMeshLab cannot open files whose names have letters outside of ASCII, and it settles that
    when it is imported. Python itself uses UTF-8, but not where ``LC_ALL`` is set.
    """
    if sys.platform == "linux" and os.environ.get("LC_ALL") in ("C", "POSIX"):
        os.environ["LC_ALL"] = "C.UTF-8"
        os.execv(sys.executable, [sys.executable, *sys.orig_argv[1:]])


if __name__ == "__main__":
    run()
