"""What users import has known types, as type checkers see them."""

import json
import os
import subprocess
import sys
from pathlib import Path

import pytest

import meshlab_willmore
from meshlab_willmore import batch, script
from tests.extras import needs

ROOT = Path(__file__).parents[1]
# Beside what the modules list themselves.
MORE = (
    "meshlab_willmore.measure.self_intersections",
    "meshlab_willmore.measure.triangle_shapes",
    "meshlab_willmore.options.FlipOptions",
    "meshlab_willmore.options.PassOptions",
    "meshlab_willmore.pyvista_accessor.WillmoreAccessor",
)


def listed_names():
    """The full names of what the modules for users list, where they list it and where it is."""
    for module in (meshlab_willmore, batch, script):
        for name in module.__all__:
            value = getattr(module, name)
            if name == "__version__" or value in (batch, script):
                continue
            yield f"{module.__name__}.{name}"
            if hasattr(value, "__qualname__"):
                yield f"{value.__module__}.{value.__qualname__}"


@pytest.mark.slow
@needs("pyright", "types")
def test_pyright_knows_the_types_of_all_that_is_public(tmp_path):
    command = ["--verifytypes", "meshlab_willmore", "--ignoreexternal", "--outputjson"]
    run = subprocess.run(
        [sys.executable, "-m", "pyright", "--pythonpath", sys.executable, *command],
        cwd=tmp_path,
        env={**os.environ, "PYTHONPATH": str(ROOT)},
        capture_output=True,
        text=True,
    )
    report = json.loads(run.stdout)["typeCompleteness"]
    assert Path(report["pyTypedPath"]) == ROOT / "meshlab_willmore" / "py.typed"
    symbols = {symbol["name"]: symbol for symbol in report["symbols"]}
    public = {*listed_names(), *MORE}
    assert public <= symbols.keys()
    unknown = {
        name: [one["message"] for one in symbol["diagnostics"]]
        for name, symbol in symbols.items()
        if (name in public or name.rpartition(".")[0] in public)
        and not (symbol["isTypeKnown"] and not symbol["isTypeAmbiguous"])
    }
    assert unknown == {}
