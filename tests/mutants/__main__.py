"""Faults that tests must find: each is planted in a copy of the sources, and its tests must fail.

By hand, from the top of the repository; no part of the suite:

    python -m tests.mutants
    python -m tests.mutants --only corners --jobs 1

A fault in a kernel runs with the JIT off, so its tests must be none of the heavy ones.
"""

import argparse
import os
import shutil
import subprocess
import sys
import tempfile
import time
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path, PurePosixPath

from meshlab_willmore.mesh.kernel_cache import SOURCES

from . import core, outside, pages, projects

FAULTS = [*core.FAULTS, *outside.FAULTS, *pages.FAULTS, *projects.FAULTS]
ROOT = Path(__file__).resolve().parents[2]
PACKAGE = "meshlab_willmore"
NEEDED = (PACKAGE, "tests", "studies", "filter_scripts", "docs")
FILES = ("README.md", "CHANGELOG.md", "pyproject.toml")
PASSED, FAILED = 0, 1
# A fault may well be that something does not end: seconds for a test, and for all of a fault.
OPTIONS = ("-x", "-q", "-n0", "--timeout=120", "-p", "no:cacheprovider")
MOST_SECONDS = 900


def is_in_kernel(fault):
    return any(PurePosixPath(fault.file).match(pattern) for pattern in SOURCES)


def wrong_texts(faults):
    """Yield a line for each text that is not there once: its fault could not be planted."""
    for fault in faults:
        path = ROOT / PACKAGE / fault.file
        count = path.read_text().count(fault.old) if path.exists() else 0
        if count != 1:
            yield f"{fault.name}: {fault.file} has its text {count} times, not once"


def run(tests, jit_is_off, fault=None):
    """Run tests in a copy of the sources; return pytest's exit code and the end of its output."""
    with tempfile.TemporaryDirectory(prefix="mutant-") as folder:
        for name in NEEDED:
            shutil.copytree(ROOT / name, Path(folder, name))
        for name in FILES:
            shutil.copy(ROOT / name, folder)
        if fault:
            path = Path(folder, PACKAGE, fault.file)
            path.write_text(path.read_text().replace(fault.old, fault.new))
        environment = {**os.environ, "PYTHONPATH": folder, "PYTHONDONTWRITEBYTECODE": "1"}
        environment["NUMBA_DISABLE_JIT"] = str(int(jit_is_off))
        program = [sys.executable, "-m", "pytest", *OPTIONS]
        try:
            done = subprocess.run(
                [*program, *tests],
                cwd=folder,
                env=environment,
                capture_output=True,
                text=True,
                timeout=MOST_SECONDS if fault else None,
                check=False,
            )
        except subprocess.TimeoutExpired:
            return FAILED, "timed out"
    return done.returncode, "\n".join(done.stdout.splitlines()[-4:]) + done.stderr[-500:]


def is_found(fault):
    """Whether its tests find a fault; a line is printed."""
    start = time.perf_counter()
    code, output = run(fault.tests.split(), is_in_kernel(fault), fault)
    verdict = {PASSED: "SURVIVED", FAILED: "red"}.get(code, f"ERROR {code}")
    print(f"{verdict:8} {fault.name} ({time.perf_counter() - start:.0f} s)", flush=True)
    if code not in (PASSED, FAILED):
        print(output, flush=True)
    return code == FAILED


def main():
    parser = argparse.ArgumentParser(prog="python -m tests.mutants", description=__doc__)
    parser.add_argument("--only", metavar="TEXT", default="", help="those with TEXT in their name")
    parser.add_argument("--jobs", type=int, default=os.cpu_count())
    options = parser.parse_args()
    chosen = [fault for fault in FAULTS if options.only in fault.name]
    if wrong := list(wrong_texts(chosen)):
        sys.exit("\n".join(wrong))
    for jit_is_off in (False, True):
        tests = {t for f in chosen if is_in_kernel(f) is jit_is_off for t in f.tests.split()}
        code, output = run(sorted(tests), jit_is_off) if tests else (PASSED, "")
        if code != PASSED:
            sys.exit(f"Tests fail without any fault:\n{output}")
    with ThreadPoolExecutor(options.jobs) as pool:
        found = list(pool.map(is_found, chosen))
    print(f"{sum(found)} of {len(found)} faults were found")
    return sum(found) != len(found)


if __name__ == "__main__":
    sys.exit(main())
