"""A folder for temporary files, in which nothing may be left."""

import tempfile
import time

import pytest

from tests.cli.conftest import _folder, _quick_machine, listing  # noqa: F401
from tests.workers import workers_here  # noqa: F401


@pytest.fixture(autouse=True)
def temporary(tmp_path_factory, monkeypatch):
    """The folder for temporary files, of this process and of those that it starts."""
    folder = tmp_path_factory.mktemp("temporary")
    monkeypatch.setenv("TMPDIR", str(folder))
    monkeypatch.setattr(tempfile, "tempdir", None)
    yield folder
    # Workers whose parent was killed remove theirs a little later.
    end = time.monotonic() + 10.0
    while listing(folder) and time.monotonic() < end:
        time.sleep(0.1)
    assert listing(folder) == []
