"""A folder as a reader of the documentation has it: a checkout in which the demo has run."""

import shutil
import sys
from pathlib import Path

import pytest

from meshlab_willmore.demo.experiments import Sizes, run_demo

from .pages import ROOT

SMALL = Sizes(torus_points=200, part_edge_percent=6.0, keep_one_of=60)


@pytest.fixture(scope="session")
def demo_files(tmp_path_factory):
    """The meshes of the demo, of smaller models."""
    folder = tmp_path_factory.mktemp("demo") / "willmore-demo"
    with pytest.MonkeyPatch.context() as patch:
        # No page needs them, and they take most of the time.
        patch.setattr("meshlab_willmore.report.pictures.can_draw", lambda: False)
        run_demo(folder, lambda line: None, SMALL)
    return folder


@pytest.fixture
def checkout(demo_files, tmp_path):
    """A checkout with the environment of this Python in it, the demo's meshes, and scans."""
    folder = tmp_path / "checkout"
    shutil.copytree(ROOT / "filter_scripts", folder / "filter_scripts")
    shutil.copytree(demo_files, folder / "willmore-demo")
    (folder / "scans").mkdir()
    for name in ("scan.ply", "scans/a.ply", "scans/b.ply"):
        shutil.copy(demo_files / "face-before.ply", folder / name)
    shutil.copy(ROOT / "filter_scripts" / "clean_and_flip.mlx", folder / "clean.mlx")
    activate = folder / ".venv" / "bin" / "activate"
    activate.parent.mkdir(parents=True)
    activate.write_text(f'PATH="{Path(sys.executable).parent}:$PATH"\n', encoding="utf-8")
    return folder
