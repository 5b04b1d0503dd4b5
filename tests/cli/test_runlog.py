"""`--log`: where a log may be written, and its errors."""

import os
import re
import socket
import stat
import sys
from pathlib import Path

import pytest

from meshlab_willmore.batch import work

from .conftest import TAUBIN, call, cube_file, listing, script_file

POSIX = pytest.mark.skipif(sys.platform == "win32", reason="links and devices of POSIX")


@pytest.fixture
def run():
    return ["run", script_file(TAUBIN), "-i", cube_file(), "-o", "out.ply"]


@pytest.fixture
def no_step(monkeypatch):
    def fail(*_arguments):
        raise AssertionError("a step ran")

    monkeypatch.setattr(work, "play", fail)


def contents():
    return {name: Path(name).read_bytes() for name in listing() if Path(name).is_file()}


@pytest.mark.parametrize("dry", [[], ["--dry-run"]])
@pytest.mark.parametrize(
    ("log", "line"),
    [
        ("cube.ply", "--log cube.ply: the log would be written into cube.ply; use a new name"),
        ("./script.mlx", "--log ./script.mlx: the log would be written into script.mlx; use a new"),
        (
            "folder/../out.ply",
            "--log folder/../out.ply: the log would be written into out.ply; use a",
        ),
        ("out.ply.mtl", "--log out.ply.mtl: the log would be written into out.ply.mtl; use a new"),
        ("mine.txt", "--log mine.txt: this file is no log of a run; use a new name"),
        ("other.ply", "--log other.ply: this file is no log of a run; use a new name"),
        ("folder", "--log folder is a folder; name a file in it, such as 'folder/log.txt'"),
        ("no/log.txt", "cannot write the log no/log.txt: there is no folder no"),
        ("mine.txt/log.txt", "cannot write the log mine.txt/log.txt: there is no folder mine.txt"),
    ],
)
def test_log_overwrites_nothing(run, no_step, log, line, dry):
    cube_file("other.ply")
    Path("mine.txt").write_text("2020-02-20: dear diary\n")
    Path("folder").mkdir()
    before = contents()
    result = call(*run, "--log", log, *dry)
    assert (result.exit_code, result.stdout) == (2, "")
    assert result.stderr.startswith(f"Error: {line}")
    assert result.stderr.count("\n") == 1
    assert contents() == before


@POSIX
@pytest.mark.parametrize("link", [os.symlink, os.link])
def test_log_is_a_link_to_an_input(run, no_step, link):
    link("cube.ply", "log.txt")
    before = contents()
    result = call(*run, "--log", "log.txt")
    assert result.exit_code == 2
    assert "the log would be written into cube.ply" in result.stderr
    assert contents() == before


def test_log_is_appended(run):
    Path("log.txt").touch()
    assert call(*run, "--log", "log.txt").exit_code == 0
    assert call(*run, "--log", "log.txt", "--force").exit_code == 0
    lines = Path("log.txt").read_text().splitlines()
    assert sum(line.endswith(" run script.mlx") for line in lines) == 2
    assert sum(line.startswith("done, ") for line in lines) == 2


@pytest.mark.parametrize("dry", [[], ["--dry-run"]])
def test_unwritable_folder_is_found_before_the_run(run, no_step, monkeypatch, dry):
    def refuse(**_given):
        raise PermissionError(13, "Permission denied")

    Path("closed").mkdir()
    monkeypatch.setattr("meshlab_willmore.mesh_files.paths.writable_folder", lambda _: None)
    monkeypatch.setattr("meshlab_willmore.files.TemporaryFile", refuse)
    result = call(*run, "--log", "closed/log.txt", *dry)
    assert result.exit_code == 1
    assert result.stderr == "Error: cannot write into closed: Permission denied\n"


def test_full_disk(run):
    if not Path("/dev/full").exists():
        pytest.skip("needs /dev/full")
    result = call(*run, "--log", "/dev/full")
    assert result.exit_code == 1
    assert result.stderr == "Error: cannot write the log /dev/full: No space left on device\n"
    assert not Path("out.ply").exists()


@POSIX
def test_log_into_a_pipe(run):
    os.mkfifo("pipe")
    result = call(*run, "--log", "pipe")
    assert result.exit_code == 1
    assert result.stderr == "Error: cannot write the log pipe: nobody reads from this pipe\n"
    end = os.open("pipe", os.O_RDONLY | os.O_NONBLOCK)
    assert call(*run, "--log", "pipe").exit_code == 0
    assert os.read(end, 1 << 16).splitlines()[-1].startswith(b"done, ")
    os.close(end)


@POSIX
@pytest.mark.parametrize("name", ["socket", "link.txt"])
def test_log_into_a_socket_is_refused(run, no_step, name):
    with socket.socket(socket.AF_UNIX) as made:
        made.bind("socket")
    Path("link.txt").symlink_to("socket")
    result = call(*run, "--log", name, "--force")
    assert result.exit_code == 1
    assert re.match(rf"Error: cannot write {name}: it (is|leads to) a socket", result.stderr)
    assert stat.S_ISSOCK(Path("socket").stat().st_mode)


@POSIX
def test_link_to_a_new_log(run):
    Path("folder").mkdir()
    Path("link.txt").symlink_to("folder/log.txt")
    assert call(*run, "--log", "link.txt").exit_code == 0
    assert Path("folder/log.txt").read_text().endswith(" s\n")
    Path("other.txt").symlink_to("no/log.txt")
    result = call(*run, "--log", "other.txt", "--force")
    assert result.exit_code == 2
    assert result.stderr.startswith("Error: cannot write the log other.txt: there is no folder ")
