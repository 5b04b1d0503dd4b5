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
from pathlib import Path
from typing import NamedTuple

from meshlab_willmore.mesh.kernel_cache import SOURCES

ROOT = Path(__file__).resolve().parents[1]
NEEDED = ("meshlab_willmore", "tests", "studies", "filter_scripts", "docs", "README.md")
FILES = (*NEEDED, "CHANGELOG.md", "pyproject.toml")
PASSED, FAILED = 0, 1
# A fault may well be that something does not end.
MOST_SECONDS = 300


class Mutant(NamedTuple):
    """A fault: `old`, which `file` has once, becomes `new`; one of `tests` at least must fail."""

    name: str
    file: str
    old: str
    new: str
    tests: str

    @property
    def is_in_kernel(self):
        return any(Path(self.file).match(f"meshlab_willmore/{pattern}") for pattern in SOURCES)


MUTANTS: list[Mutant] = []


def check_texts(mutants):
    """Every text must be there, once: a table that the sources have left behind finds nothing."""
    for mutant in mutants:
        path = ROOT / mutant.file
        count = path.read_text().count(mutant.old) if path.exists() else 0
        if count != 1:
            yield f"{mutant.name}: {mutant.file} has its text {count} times, not once"


def run(tests, jit_is_off, mutant=None):
    """Run tests in a copy of the sources; return pytest's exit code and the end of its output."""
    with tempfile.TemporaryDirectory(prefix="mutant-") as folder:
        for name in FILES:
            copy = shutil.copytree if (ROOT / name).is_dir() else shutil.copy
            copy(ROOT / name, Path(folder, name))
        if mutant:
            path = Path(folder, mutant.file)
            path.write_text(path.read_text().replace(mutant.old, mutant.new))
        environment = {**os.environ, "PYTHONPATH": folder, "PYTHONDONTWRITEBYTECODE": "1"}
        environment["NUMBA_DISABLE_JIT"] = str(int(jit_is_off))
        program = [sys.executable, "-m", "pytest", "-x", "-q", "-n0", "-p", "no:cacheprovider"]
        try:
            done = subprocess.run(
                [*program, *tests],
                cwd=folder,
                env=environment,
                capture_output=True,
                text=True,
                timeout=MOST_SECONDS,
            )
        except subprocess.TimeoutExpired:
            return FAILED, "timed out"
        return done.returncode, "\n".join(done.stdout.splitlines()[-3:]) + done.stderr[-500:]


def judged(mutant):
    """Whether tests found a fault, and a line that says which."""
    start = time.perf_counter()
    code, output = run(mutant.tests.split(), mutant.is_in_kernel, mutant)
    verdict = {PASSED: "SURVIVED", FAILED: "red"}.get(code, f"ERROR, exit code {code}: {output}")
    line = f"{verdict:8} {mutant.name} ({time.perf_counter() - start:.0f} s)"
    print(line if code in (PASSED, FAILED) else line + "\n" + output, flush=True)
    return code == FAILED


def main():
    parser = argparse.ArgumentParser(prog="python -m tests.mutants", description=__doc__)
    parser.add_argument("--only", metavar="TEXT", default="", help="those with TEXT in their name")
    parser.add_argument("--jobs", type=int, default=os.cpu_count())
    options = parser.parse_args()
    chosen = [mutant for mutant in MUTANTS if options.only in mutant.name]
    if wrong := list(check_texts(chosen)):
        sys.exit("\n".join(wrong))
    for jit_is_off in (False, True):
        tests = {t for m in chosen if m.is_in_kernel is jit_is_off for t in m.tests.split()}
        code, output = run(sorted(tests), jit_is_off) if tests else (PASSED, "")
        if code != PASSED:
            sys.exit(f"Without any fault too, tests fail:\n{output}")
    with ThreadPoolExecutor(options.jobs) as pool:
        found = list(pool.map(judged, chosen))
    print(f"{sum(found)} of {len(found)} faults were found")
    return sum(found) != len(found)


if __name__ == "__main__":
    sys.exit(main())
