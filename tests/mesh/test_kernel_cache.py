"""The disk cache of kernels: its key, and damaged files."""

import ast
import errno
import shutil
from pathlib import Path

import numba
import pytest

import meshlab_willmore.optimize  # noqa: F401 - it brings all kernels
from meshlab_willmore.mesh import kernel_cache
from meshlab_willmore.mesh.jit import KERNELS, damaged_entries, jit

PACKAGE = Path(kernel_cache.__file__).parents[1]


def twice(x):
    return 2 * x


@pytest.fixture
def folder(monkeypatch, tmp_path):
    """An empty cache, and no kernel in it but those of the test."""
    monkeypatch.setattr(numba.config, "CACHE_DIR", str(tmp_path))
    monkeypatch.setattr("meshlab_willmore.mesh.jit.KERNELS", [])
    return tmp_path


def kernel():
    """`twice` as a new process would find it: hits and misses in the cache are counted anew."""
    return jit(twice)


def misses(compiled):
    assert compiled(3) == 6
    return sum(compiled.stats.cache_misses.values())


def cut(path):
    path.write_bytes(path.read_bytes()[: path.stat().st_size // 2])


def empty(path):
    path.write_bytes(b"")


def alter(path):
    data = bytearray(path.read_bytes())
    data[len(data) // 2] ^= 1
    path.write_bytes(data)


@pytest.mark.heavy
@pytest.mark.parametrize("harm", [cut, empty, alter])
@pytest.mark.parametrize("suffix", ["nbi", "nbc"])
def test_a_damaged_file_is_found_compiled_again_and_replaced(folder, harm, suffix):
    assert [misses(kernel()), misses(kernel())] == [1, 0]
    assert damaged_entries() == []
    (path,) = folder.rglob(f"*.{suffix}")
    harm(path)
    damaged = kernel_cache.damaged_files(path.parent)
    assert damaged == [str(path)]
    assert [misses(kernel()), misses(kernel())] == [1, 0]
    assert kernel_cache.damaged_files(path.parent) == []


@pytest.mark.heavy
def test_the_damaged_files_of_kernels_in_use_are_listed(folder):
    misses(kernel())
    (path,) = folder.rglob("*.nbc")
    cut(path)
    assert damaged_entries() == [str(path)]


@pytest.mark.heavy
def test_a_full_disk_costs_the_time_to_compile_only(folder, monkeypatch):
    def full(self, path):
        raise OSError(errno.ENOSPC, "No space left on device")

    monkeypatch.setattr(kernel_cache._Files, "_open_for_write", full)
    monkeypatch.setattr(kernel_cache, "write_errors", [])
    assert [misses(kernel()), misses(kernel())] == [1, 1]
    assert [error.errno for error in kernel_cache.write_errors] == [errno.ENOSPC] * 2


@pytest.mark.heavy
def test_a_file_that_was_moved_is_compiled_anew(folder, monkeypatch):
    assert misses(kernel()) == 1
    monkeypatch.setattr(twice, "__module__", "moved")
    assert [misses(kernel()), misses(kernel())] == [1, 0]


def key_of(monkeypatch, package):
    monkeypatch.setattr(kernel_cache, "_PACKAGE", package)
    kernel_cache.source_key.cache_clear()
    return kernel_cache.source_key()


@pytest.fixture
def copy(tmp_path):
    """The package in another folder."""
    yield Path(shutil.copytree(PACKAGE, tmp_path / "elsewhere"))
    kernel_cache.source_key.cache_clear()


def test_the_key_is_that_of_the_sources_and_flags_not_of_the_folder(monkeypatch, copy):
    before = key_of(monkeypatch, PACKAGE)
    assert key_of(monkeypatch, copy) == before
    (copy / "cli/warmup.py").write_text("")
    assert key_of(monkeypatch, copy) == before
    with open(copy / "energy/angles.py", "a") as helper:
        helper.write("\n")
    edited = key_of(monkeypatch, copy)
    assert edited != before
    monkeypatch.setattr(numba.config, "BOUNDSCHECK", not numba.config.BOUNDSCHECK)
    assert key_of(monkeypatch, copy) not in (before, edited)


def sources():
    return {path for pattern in kernel_cache.SOURCES for path in PACKAGE.glob(pattern)}


def test_all_kernels_are_among_the_sources():
    ours = {
        Path(getattr(kernel, "py_func", kernel).__code__.co_filename)
        for kernel in KERNELS
        if getattr(kernel, "py_func", kernel).__module__.startswith("meshlab_willmore")
    }
    assert len(ours) > 20
    assert ours <= sources()


def imported(path):
    """Each name that a file imports from the package, with the file that it comes from."""
    for node in ast.walk(ast.parse(path.read_text())):
        if isinstance(node, ast.ImportFrom) and node.level:
            folder = path.parents[node.level - 1].joinpath(*(node.module or "").split("."))
            for name in node.names:
                whole = folder / name.name
                yield name.name, (whole if whole.with_suffix(".py").exists() else folder)


def test_the_sources_take_no_constants_from_other_files():
    others = {
        (path.name, name)
        for path in sources()
        for name, module in imported(path)
        if not {module.with_suffix(".py"), module / "__init__.py"} & sources()
    }
    # How many items a thread gets at a time; no kernel of that file reads it.
    assert {other for other in others if other[1].isupper()} == {("rounds.py", "CHUNK")}


def test_without_a_home_nothing_is_kept_in_the_working_folder(monkeypatch, tmp_path):
    monkeypatch.setattr(kernel_cache.config, "CACHE_DIR", "")
    for name in ("XDG_CACHE_HOME", "LOCALAPPDATA", "APPDATA"):
        monkeypatch.delenv(name, raising=False)
    monkeypatch.setattr("os.path.expanduser", lambda path: path)
    source = tmp_path / "source.py"
    assert list(kernel_cache._folders(source)) == [str(tmp_path / "__pycache__")]
