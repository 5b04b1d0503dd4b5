"""A Numba cache of the session's own, and the mark of tests that need the compiler.

Numba does not notice when a helper in another file has changed, so the tests never use an old
cache.
"""

import atexit
import os
import shutil
import signal
import tempfile

import pytest

# Started in the background (nohup, some CI), a process ignores these, and so would its children.
signal.signal(signal.SIGINT, signal.default_int_handler)
if hasattr(signal, "SIGHUP"):
    signal.signal(signal.SIGHUP, signal.SIG_DFL)

JIT_IS_OFF = os.environ.get("NUMBA_DISABLE_JIT", "0") not in ("", "0")
IS_WORKER = "PYTEST_XDIST_WORKER" in os.environ

if not JIT_IS_OFF and not IS_WORKER:
    # Through the environment, so that workers and subprocesses share it; before Numba is imported.
    own_cache = tempfile.mkdtemp(prefix="willmore-numba-")
    os.environ["NUMBA_CACHE_DIR"] = own_cache
    atexit.register(shutil.rmtree, own_cache, ignore_errors=True)


def pytest_collection_modifyitems(items):
    if JIT_IS_OFF:
        for item in items:
            if item.get_closest_marker("heavy"):
                item.add_marker(pytest.mark.skip(reason="heavy, and the JIT is off"))
