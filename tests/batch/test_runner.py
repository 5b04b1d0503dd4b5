"""A batch in Python: results as they come, of scripts and functions, resumed as it was left."""

import json
import os
import signal
import subprocess
import sys
import threading
import time
from pathlib import Path

import pytest

from meshlab_willmore import batch
from meshlab_willmore.batch import records
from meshlab_willmore.messages import WrongUse
from meshlab_willmore.mlx.steps import ScriptError
from tests.cli.conftest import FLIP, TAUBIN, call, cube_file, listing, same_mesh, script_file
from tests.cli.test_compare_row import is_running, wait_for

POSIX = pytest.mark.skipif(sys.platform == "win32", reason="signals of POSIX")


def meshes_with_a_bad_one():
    for folder in ("in/a", "in/b", "out"):
        Path(folder).mkdir(parents=True)
    cube_file("in/a/one.ply")
    cube_file("in/b/two.ply")
    Path("in/b/bad.ply").write_text("no mesh")


def statuses(results):
    return {result.input: result.status for result in results}


def test_script_on_many_meshes_and_again(request):
    """One test for all that needs workers anyway."""
    meshes_with_a_bad_one()
    script = script_file(FLIP, TAUBIN)
    given = {"log": "log.jsonl", "workers": 1}
    results = list(batch.run(script, "in/**/*.ply", "out/{dir}/{name}.ply", **given))
    assert statuses(results) == {
        "in/a/one.ply": "done",
        "in/b/two.ply": "done",
        "in/b/bad.ply": "bad file",
    }
    alone = call("run", script, "-i", "in/a/one.ply", "-o", "alone.ply")
    assert alone.exit_code == 0
    assert same_mesh("alone.ply", "out/in/a/one.ply")
    assert Path("alone.ply").read_bytes() == Path("out/in/b/two.ply").read_bytes()

    done = next(result for result in results if result.is_done)
    (saved,) = done.outputs
    assert (saved.bytes, saved.faces) == (Path(saved.file).stat().st_size, 24)
    assert [step.number for step in done.returned] == [1]
    assert done.returned[0].returned["flips"] > 0
    assert done.before["willmore_energy"] > done.after["willmore_energy"]
    assert done.size == Path("in/a/one.ply").stat().st_size
    begun, *lines = [json.loads(line) for line in Path("log.jsonl").read_text().splitlines()]
    assert begun["recipe"] == done.recipe
    assert [records.from_json(line).input for line in lines] == [r.input for r in results]
    assert {line["status"] for line in lines} == {"done", "bad file"}

    # The rest is none of the workers' business.
    request.getfixturevalue("workers_here")
    # What is done, or failed, stays; a line that was cut, an output that is not whole and another
    # input are done again.
    times = {path: path.stat().st_mtime_ns for path in Path("out").rglob("*.ply")}
    cube_file("in/a/more.ply")
    with Path("log.jsonl").open("a") as log:
        log.write('{"input": "in/a/mo')
    Path("out/in/b/two.ply").write_bytes(b"half")
    pattern = "out/{dir}/{name}.ply"
    again = list(batch.run(script, "in/**/*.ply", pattern, resume=True, **given))
    assert statuses(again) == {"in/a/more.ply": "done", "in/b/two.ply": "done"}
    assert same_mesh("alone.ply", "out/in/b/two.ply")
    one = Path("out/in/a/one.ply")
    assert one.stat().st_mtime_ns == times[one]

    # Nothing is left to do: no worker starts.
    assert list(batch.run(script, "in/**/*.ply", pattern, resume=True, **given)) == []
    failed = batch.run(script, "in/**/*.ply", pattern, retry_failed=True, **given)
    assert statuses(failed) == {"in/b/bad.ply": "bad file"}
    # What is done has not been written to another name.
    elsewhere = batch.run(script, "in/a/*.ply", "out/{index}.ply", resume=True, **given)
    assert statuses(elsewhere) == {"in/a/one.ply": "done", "in/a/more.ply": "done"}
    # Another script is another batch.
    other = [script_file(FLIP), "in/a/*.ply", "out/{index}.ply"]
    others = list(batch.run(*other, resume=True, force=True, **given))
    assert statuses(others) == {"in/a/one.ply": "done", "in/a/more.ply": "done"}


HASH = """
from meshlab_willmore.batch.jobs import Job
from meshlab_willmore.batch.recipe import Recipe
from meshlab_willmore.batch.runner import Batch, BatchOptions
from meshlab_willmore.mesh_files.paths import Output
outputs = tuple(Output(f"{part}.ply", (part,)) for part in ("vc", "fc", "vn", "wt"))
print(Batch(Recipe((), "script"), [Job((), outputs)], BatchOptions())._hash)
"""


def test_recipe_is_the_same_in_each_process():
    """Python's order of sets is not."""
    hashes = {
        subprocess.run(
            [sys.executable, "-c", HASH],
            env={**os.environ, "PYTHONHASHSEED": str(seed)},
            stdout=subprocess.PIPE,
            check=True,
        ).stdout
        for seed in (1, 2)
    }
    assert len(hashes) == 1


def test_files_of_others_are_not_replaced(monkeypatch):
    cube_file("a.ply")
    Path("a_out.ply").write_text("mine")
    with pytest.raises(WrongUse, match=r"a_out\.ply already exists"):
        list(batch.run(script_file(FLIP), "a.ply", "{name}_out.ply"))
    with pytest.raises(WrongUse, match=r"a_out\.ply already exists"):
        list(batch.run(script_file(FLIP), "a.ply", "{name}_out.ply", log="log", resume=True))
    assert Path("a_out.ply").read_text() == "mine"


@pytest.mark.parametrize(
    ("given", "line"),
    [
        ({"workers": 0}, "workers is 0, but must be 1 or more"),
        ({"timeout": float("nan")}, "timeout is nan, which is no number of seconds"),
        ({"timeout": -1.0}, "timeout is -1"),
        ({"memory": 1000}, "memory is 1000, but must be 268435456 or more"),
        ({"resume": True}, "its log is needed"),
        ({"log": "a.ply"}, "a.ply holds no records of a batch"),
        ({"log": "."}, "is a folder"),
        ({"log": "no/log.jsonl"}, "the folder no does not exist"),
        ({"shard": "3/2"}, "--shard 3/2"),
    ],
)
def test_wrong_numbers_and_files_are_named(given, line):
    cube_file("a.ply")
    with pytest.raises(WrongUse) as caught:
        list(batch.run(script_file(FLIP), "a.ply", None, **given))
    assert line in str(caught.value)


@pytest.mark.usefixtures("workers_here")
def test_input_that_changes_while_it_is_processed_is_done_again():
    cube_file("a.ply")
    whole = Path.cwd() / "a.ply"

    def replaced(ms):
        whole.write_bytes(whole.read_bytes() + b"\n")

    given = {"log": "log.jsonl", "force": True}
    for _ in range(2):
        again = batch.run(replaced, "a.ply", "{name}_out.ply", **given, resume=True)
        assert statuses(again) == {"a.ply": "done"}
    # What replaces its own input is done.
    first = batch.run(script_file(TAUBIN), "a.ply", "{dir}/a.ply", **given, resume=True)
    assert statuses(first) == {"a.ply": "done"}
    again = batch.run(script_file(TAUBIN), "a.ply", "{dir}/a.ply", **given, resume=True)
    assert statuses(again) == {}


@pytest.mark.usefixtures("workers_here")
def test_failure_in_saving_is_named():
    cube_file("a.ply")
    (result,) = batch.run(lambda ms: ms.clear(), "a.ply", "{name}_out.ply")
    assert (result.status, result.step) == ("error", "saving")
    assert result.reason == "cannot write a_out.ply: the script leaves no mesh"


def test_function_that_cannot_be_sent_is_named():
    lock = threading.Lock()

    def work(ms):
        lock.acquire()

    with pytest.raises(WrongUse, match=r"work can't be sent to workers: cannot pickle .*lock"):
        next(batch.run(work, "a.ply"))


def test_no_inputs_have_no_results():
    assert list(batch.run(script_file(FLIP), [])) == []


def test_folder_that_cannot_be_made_is_named():
    cube_file("a.ply")
    Path("out").mkdir()
    Path("out/a").touch()
    with pytest.raises(OSError, match=r"cannot write into out/a: it is a file"):
        next(batch.run(script_file(FLIP), "a.ply", "out/{name}/{name}.ply"))


def test_faulty_script_is_refused():
    with pytest.raises(ScriptError, match="Taubin Smoth"):
        list(batch.run(script_file(("Taubin Smoth", {})), "a.ply", None))


# A script without a guard, with a function of its own, and a mesh on which it hangs.
UNGUARDED = """
import sys
from meshlab_willmore import batch
print("begun", flush=True)
factor = 3
def work(ms):
    if ms.current_mesh().face_number() == 320:
        open("hanging", "w").close()
        ms.apply_coord_laplacian_smoothing(stepsmoothnum=10**9)
    return {"faces": ms.current_mesh().face_number() * factor}
for result in batch.run(work, sys.argv[1:], "out/{name}.ply", workers=2, log="log.jsonl"):
    print(result.status, result.returned[0].returned, result.step, flush=True)
"""


@pytest.mark.slow
def test_function_of_a_script_without_a_guard():
    cube_file("a.ply")
    cube_file("b.ply")
    Path("out").mkdir()
    Path("unguarded.py").write_text(UNGUARDED)
    done = subprocess.run(
        [sys.executable, "unguarded.py", "a.ply", "b.ply"],
        capture_output=True,
        text=True,
        check=False,
    )
    line = "done {'faces': 72} \n"
    assert (done.stdout, done.stderr) == (f"begun\n{line}{line}", "")


@POSIX
@pytest.mark.slow
@pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGTERM, signal.SIGKILL])
def test_nothing_is_left_of_a_batch_that_is_stopped(number, temporary):
    import pymeshlab

    Path("out").mkdir()
    Path("unguarded.py").write_text(UNGUARDED)
    ms = pymeshlab.MeshSet()
    ms.create_sphere(subdiv=2)
    ms.save_current_mesh("sphere.ply")
    program = [sys.executable, "unguarded.py", "sphere.ply"]
    with subprocess.Popen(program, stdout=subprocess.PIPE, stderr=subprocess.PIPE) as process:
        wait_for(Path("hanging").exists)
        lists = Path(f"/proc/{process.pid}/task").glob("*/children")
        workers = [int(pid) for path in lists for pid in path.read_text().split()]
        assert workers or sys.platform != "linux"
        start = time.monotonic()
        process.send_signal(number)
        process.communicate(timeout=60)
    for pid in workers:
        wait_for(lambda pid=pid: not is_running(pid))
    assert time.monotonic() - start < 2.0
    wait_for(lambda: listing(temporary) == [])
    assert listing("out") == []


@pytest.mark.usefixtures("workers_here")
@POSIX
def test_what_a_killed_batch_left_is_removed_when_it_goes_on(temporary):
    """Kill -9 of all its processes leaves temporary folders."""
    from meshlab_willmore.batch.pool import own_mark

    cube_file("a.ply")
    gone = subprocess.Popen([sys.executable, "-c", ""])
    gone.wait()
    dead = own_mark().replace(str(os.getpid()), str(gone.pid))
    left = [Path(f".a.xyz{dead}-0"), temporary / f"meshlab_willmore_xyz{dead}-1"]
    kept = [Path(f".b.xyz{own_mark()}-0"), Path(".c.other")]
    for folder in (*left, *kept):
        folder.mkdir()
    script = script_file(FLIP)
    results = batch.run(script, "no.ply", "{name}_out.ply", log="log.jsonl", resume=True)
    with pytest.raises(WrongUse, match="there is no file"):
        list(results)
    list(batch.run(script, "a.ply", "{name}_out.ply", log="log.jsonl", resume=True))
    assert not any(folder.exists() for folder in left)
    assert all(folder.exists() for folder in kept)
