"""The disk cache of compiled kernels.

Numba keys its cache by the source file of a kernel alone, so it does not notice an edited helper in
another file, nor flags such as ``NUMBA_BOUNDSCHECK``; and it fails on a file that was cut short.
Here the key is a hash over the sources of all kernels and over all that changes the code, and each
file ends in a checksum. Damaged files are compiled again and replaced; a folder that cannot be
written costs each process the time to compile, and nothing else.
"""

import functools
import hashlib
import os
import pickle
import tempfile
import zlib
from collections.abc import Callable
from pathlib import Path

import llvmlite
import numba
from numba import config
from numba.core.caching import CompileResultCacheImpl, FunctionCache, IndexDataCacheFile
from numba.misc.appdirs import AppDirs

_PACKAGE = Path(__file__).resolve().parents[1]
# What kernels are made of, seen from the package's folder.
SOURCES = (
    "energy/*.py",
    "folds.py",
    "guards/*.py",
    "measure.py",
    "mesh/build.py",
    "mesh/halfedge.py",
    "mesh/jit.py",
    "mesh/lanes.py",
    "mesh/normals.py",
    "mesh/points.py",
    "mesh/rounding.py",
    "search/*.py",
)
# Settings of Numba that change the code, but for the processor's, by which Numba itself keys.
_FLAGS = (
    "BOUNDSCHECK",
    "DEBUGINFO_DEFAULT",
    "DISABLE_INTEL_SVML",
    "ENABLE_AVX",
    "LLVM_REFPRUNE_FLAGS",
    "LLVM_REFPRUNE_PASS",
    "LOOP_VECTORIZE",
    "OPT",
    "SLP_VECTORIZE",
)
_CHECKSUM_BYTES = 4
# In the name of each file: Numba's own files beside them have no checksum.
_MARK = "-crc"


@functools.lru_cache(maxsize=1)
def source_key() -> str:
    """Return a hash over the kernels' sources, Numba, llvmlite and the flags that change code.

    Returns
    -------
    str
        Hexadecimal digits. The same wherever the package is installed.
    """
    found = hashlib.sha256()
    for pattern in SOURCES:
        for path in sorted(_PACKAGE.glob(pattern)):
            found.update(path.relative_to(_PACKAGE).as_posix().encode() + b"\0")
            found.update(path.read_bytes() + b"\0")
    flags = {name: str(getattr(config, name, None)) for name in _FLAGS}
    found.update(repr((numba.__version__, llvmlite.__version__, flags)).encode())
    return found.hexdigest()[:16]


class _Locator:
    """The folder for one kernel, in the form that Numba's cache asks for."""

    def __init__(self, folder, source, function):
        self._folder = folder
        self._py_file = source
        self._line = function.__code__.co_firstlineno
        self._module = function.__module__

    @classmethod
    def from_function(cls, function, source):
        """Return a locator with the first folder that can be written, or None."""
        for folder in _folders(source):
            if _is_writable(folder):
                return cls(folder, source, function)
        return None

    def ensure_cache_path(self):
        os.makedirs(self._folder, exist_ok=True)

    def get_cache_path(self):
        return self._folder

    def get_source_stamp(self):
        if _PACKAGE in Path(self._py_file).resolve().parents:
            return source_key()
        # What is kept imports its module by name, which a file that was moved no longer has.
        found = hashlib.sha256(self._module.encode() + b"\0" + Path(self._py_file).read_bytes())
        return source_key() + found.hexdigest()

    def get_disambiguator(self):
        return str(self._line)


def _folders(source):
    """Yield where to look: ``NUMBA_CACHE_DIR``, beside the source, the user's own cache.

    The first and the last may be shared by several installations, so their folders are named after
    the sources. A shared temporary folder would be no way out: a cache is code, and others could
    put theirs there.
    """
    source = Path(source)
    shared = Path(f"{_PACKAGE.name}-{source_key()}", source.parent.name)
    if config.CACHE_DIR:
        yield str(Path(config.CACHE_DIR).absolute() / shared)
    yield str(source.parent / "__pycache__")
    own = Path(AppDirs(appname="numba", appauthor=False).user_cache_dir)
    # Without a home it is a folder called ~, in whatever folder the process works.
    if own.is_absolute():
        yield str(own / shared)


@functools.cache
def _is_writable(folder):
    try:
        os.makedirs(folder, exist_ok=True)
        tempfile.TemporaryFile(dir=folder).close()
    except OSError:
        return False
    return True


class _Results(CompileResultCacheImpl):
    """Numba's way to store what it compiled, in our folders."""

    _locator_classes = [_Locator]  # type: ignore[list-item]  # noqa: RUF012


class _Files(IndexDataCacheFile):
    """The index and the code of a kernel, with a checksum at the end of each file."""

    def _load_index(self):
        try:
            with open(self._index_path, "rb") as file:
                stamp, entries = pickle.loads(_checked(file.read()))
        except OSError:
            return {}
        return entries if stamp == self._stamp else {}

    def _save_index(self, overloads):
        self._write(self._index_path, (self._stamp, overloads))

    def _load_data(self, name):
        # An OSError is what Numba takes for a file that is gone: it compiles anew.
        with open(self._data_path(name), "rb") as file:
            return pickle.loads(_checked(file.read()))

    def _save_data(self, name, data):
        self._write(self._data_path(name), data)

    def _write(self, path, content):
        data = self._dump(content)
        with self._open_for_write(path) as file:
            file.write(data + zlib.crc32(data).to_bytes(_CHECKSUM_BYTES, "little"))

    @property
    def _stamp(self):
        return (self._version, self._source_stamp)


def _checked(data):
    """Return `data` without the checksum at its end; an `OSError` where that does not fit."""
    content, checksum = data[:-_CHECKSUM_BYTES], data[-_CHECKSUM_BYTES:]
    if zlib.crc32(content).to_bytes(_CHECKSUM_BYTES, "little") != checksum:
        raise OSError("damaged")
    return content


class KernelCache(FunctionCache):
    """The cache of one kernel.

    Parameters
    ----------
    function : function
        What is compiled.

    Raises
    ------
    RuntimeError
        There is no folder that can be written.
    """

    _impl_class = _Results

    def __init__(self, function):
        super().__init__(function)
        name, stamp = self._impl.filename_base + _MARK, self._impl.locator.get_source_stamp()
        self._cache_file = _Files(self._cache_path, name, stamp)
        # Waits until another process has compiled it, if one does.
        self.wait: Callable[[], object] | None = None

    def load_overload(self, sig, target_context):
        """Return what was compiled, or None; wait for it if another process is about to."""
        found = super().load_overload(sig, target_context)
        if found is None and self.wait:
            self.wait()
            self.wait = None
            found = super().load_overload(sig, target_context)
        return found

    def is_empty(self):
        """Whether nothing is kept of this kernel."""
        return not self._cache_file._load_index()

    def save_overload(self, sig, data):
        """Keep what was compiled, if the disk has room for it and it may be written."""
        try:
            super().save_overload(sig, data)
        except OSError as error:
            write_errors.append(error)


# What has kept this process from writing to the cache.
write_errors: list[OSError] = []


def damaged_files(folder) -> list[str]:
    """Return the files in a folder of the cache that are not what was written.

    Parameters
    ----------
    folder : str or os.PathLike

    Returns
    -------
    list of str
        Paths.
    """
    files = sorted(Path(folder).glob(f"*{_MARK}*.nb[ci]"))
    return [str(path) for path in files if _is_damaged(path)]


def _is_damaged(path):
    try:
        _checked(path.read_bytes())
    except OSError:
        return True
    return False
