"""Tools that not everybody who runs the tests has installed."""

import importlib.util
import os

import pytest

# Where everything is installed, and a missing tool is a failure.
IS_CI = os.environ.get("CI") == "true"


def needs(tool, extra):
    """A mark for tests that need a module of an extra, and are skipped without it outside CI."""
    missing = not IS_CI and importlib.util.find_spec(tool) is None
    return pytest.mark.skipif(
        missing, reason=f"{tool} is missing: pip install 'meshlab-willmore[{extra}]'"
    )
