"""What workers do in tests."""

import os
import signal
import subprocess
import sys
import time
from pathlib import Path

from meshlab_willmore.batch.process import Phase
from meshlab_willmore.files import folder_beside

_done = []


def give(argument, _say):
    """Return the argument."""
    _done.append(argument)
    return argument


def count(_argument, _say):
    """How many tasks this process has done before, and its number."""
    _done.append(None)
    return len(_done), os.getpid()


def crash(_argument, _say):
    os.kill(os.getpid(), signal.SIGSEGV)


def crash_with_a_child(path, _say):
    """Leave a child behind that holds all descriptors, and crash."""
    child = os.fork()
    if child == 0:
        time.sleep(1000)
    with open(path, "w") as file:
        file.write(str(child))
    os.abort()


def crash_unless_fresh(argument, _say):
    """Crash by what another task has left behind."""
    if _done:
        os.abort()
    return argument


def crash_and_count(path, _say):
    with open(path, "a") as file:
        file.write("x")
    os.abort()


def hang(path, say):
    """Hang in native code, with a child."""
    import pymeshlab

    child = subprocess.Popen([sys.executable, "-c", "import time; time.sleep(1000)"])
    with open(path, "w") as file:
        file.write(str(child.pid))
    say(Phase("hanging"))
    ms = pymeshlab.MeshSet()
    ms.create_sphere(subdiv=4)
    ms.apply_coord_laplacian_smoothing(stepsmoothnum=10**9)


def fail(_argument, _say):
    raise ValueError("a reason\nof two lines")


def fail_once(path, _say):
    """Fail, but for the second time."""
    if not os.path.exists(path):
        open(path, "w").close()
        raise ValueError("not yet")
    return "at last"


def leave(_argument, _say):
    sys.exit(3)


def eat(_argument, _say):
    """Take memory until there is none."""
    import numpy as np

    taken = []
    while True:
        taken.append(np.ones(1 << 22))


def print_noise(argument, _say):
    """Print on the standard output, as native filters do."""
    os.write(1, b"noise" * 1000)
    return argument


def crash_while_saving(path, _say):
    with folder_beside(Path(path)) as folder:
        (folder / "half").write_text("half")
        os.abort()


def make_a_file(_argument, _say):
    """Make a temporary file, and crash."""
    import tempfile

    tempfile.mkdtemp()
    os.abort()


def limit(_argument, _say):
    """The limit of the address space."""
    import resource

    return resource.getrlimit(resource.RLIMIT_AS)[0]


def give_slowly(argument, _say):
    """Return the argument, so late that a machine is lost meanwhile."""
    time.sleep(0.8)
    return argument
