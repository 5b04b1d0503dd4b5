"""Options of a batch on the command line, what is printed, and summaries of records."""

import json
import os
import subprocess
from pathlib import Path

import pytest

from .conftest import FLIP, TAUBIN, call, cube_file, listing, same_mesh, script_file, spawn


@pytest.mark.slow
def test_records_resume_shards_and_summary():
    """One test for all that needs workers anyway."""
    # Both shares have good ones: "three" and "bad" are the first.
    for name in ("one", "three", "four"):
        cube_file(f"{name}.ply")
    Path("bad.ply").write_text("no mesh")
    script = script_file(TAUBIN)
    arguments = ["run", script, "-i", "*.ply", "-o", "out/{name}.off", "--workers", 1]
    Path("out").mkdir()
    first = call(*arguments, "--shard", "1/2", "--json", "1.jsonl", "--log", "log.txt")
    second = call(
        *arguments, "--shard", "2/2", "--json", "2.jsonl", "--summary", "--log", "log.txt"
    )
    assert sorted((first.exit_code, second.exit_code)) == [0, 1]
    assert listing("out") == ["four.off", "one.off", "three.off"]
    assert "apply_coord_taubin_smoothing" in Path("log.txt").read_text()
    assert "most memory of a worker: " in second.stdout

    total = call("summary", "*.jsonl")
    assert total.exit_code == 1
    assert total.stdout.startswith("4 inputs: 3 done, 1 bad file; ")
    assert "  bad file: cannot read bad.ply: Header not found\n" in total.stdout
    as_json = json.loads(call("summary", "1.jsonl", "2.jsonl", "--json").stdout)
    assert as_json["counts"] == {"done": 3, "bad file": 1}
    assert [record["input"] for record in as_json["failed"]] == ["bad.ply"]

    # The file of another shard is no reason to do anything again, nor is a failure.
    again = call(*arguments, "--json", "2.jsonl", "--shard", "2/2", "--resume")
    assert again.exit_code == second.exit_code
    assert again.stdout == ""
    lines = Path("2.jsonl").read_text()
    left = call(*arguments, "--json", "2.jsonl", "--shard", "2/2", "--retry-failed", "--dry-run")
    assert (left.exit_code, left.stdout) == (0, "")
    assert Path("2.jsonl").read_text() == lines
    refused = call(*arguments, "--json", "2.jsonl")
    assert refused.exit_code == 2
    assert refused.stderr.startswith("Error: out/four.off already exists")


@pytest.mark.usefixtures("workers_here")
def test_several_meshes_are_flipped_as_one():
    cube_file("one.ply")
    cube_file("two.ply")
    result = call("flip", "one.ply", "two.ply", "{name}_flipped.off", "--energy", "willmore",
                  "--no-monotone", "--json", "log.jsonl")  # fmt: skip
    assert result.exit_code == 0, result.stderr
    line = "one.ply -> one_flipped.off: 10 flips, Willmore energy 45.757 -> "
    assert sum(text.startswith(line) for text in result.stdout.splitlines()) == 1
    call("flip", "one.ply", "alone.off", "--energy", "willmore", "--no-monotone")
    assert same_mesh("alone.off", "two_flipped.off")
    _, *records = [json.loads(line) for line in Path("log.jsonl").read_text().splitlines()]
    assert [record["returned"][0]["returned"]["flips"] for record in records] == [10, 10]


@pytest.mark.slow
def test_limit_makes_a_batch_of_one_mesh(cube):
    endless = ("Laplacian Smooth", {"stepSmoothNum": ("RichInt", 10**9)})
    script = script_file(TAUBIN, endless)
    result = call("run", script, "-i", cube, "-o", "out.ply", "--timeout", 1, "--json", "log.jsonl")
    assert (result.exit_code, result.stdout) == (1, "")
    assert result.stderr == (
        "Error: cube.ply: step 2 (apply_coord_laplacian_smoothing): not finished within 1 s\n"
    )
    record = json.loads(Path("log.jsonl").read_text().splitlines()[-1])
    assert record["status"] == "timeout"
    assert listing() == ["cube.ply", "log.jsonl", "script.mlx"]


@pytest.mark.parametrize(
    ("arguments", "line"),
    [
        (["--resume"], "--resume needs --json FILE.jsonl"),
        (["--memory", "much"], "--memory much: it must be a size such as 4G or 500M"),
        (["--memory", "1K"], "--memory 1K: a worker needs 256M or more"),
        (["--shard", "auto"], "--shard auto: there is neither"),
        (["--workers", "0"], "Invalid value for '--workers'"),
        (["--json", "cube.ply"], "cube.ply holds no records of a batch; use a new name"),
    ],
)
def test_wrong_options_are_named(cube, arguments, line):
    result = call("run", script_file(FLIP), "-i", cube, "-o", "out.ply", *arguments)
    assert (result.exit_code, result.stdout) == (2, "")
    assert result.stderr.startswith(f"Error: {line}")
    assert result.stderr.count("\n") == 1
    assert not Path("out.ply").exists()


def test_scheduler_that_is_not_there(cube):
    pytest.importorskip("distributed")
    import dask

    arguments = ["run", script_file(FLIP), "-i", cube, "-o", "out.ply", "--scheduler"]
    with dask.config.set({"distributed.comm.timeouts.connect": "0.2s"}):
        result = call(*arguments, "tcp://127.0.0.1:1")
    assert (result.exit_code, result.stdout) == (1, "")
    assert result.stderr.startswith("Error: the scheduler tcp://127.0.0.1:1 can't be reached: ")
    assert result.stderr.count("\n") == 1


@pytest.mark.skipif(not hasattr(os, "mkfifo"), reason="no named pipes")
@pytest.mark.slow
def test_records_go_into_a_pipe(cube):
    os.mkfifo("pipe.jsonl")
    arguments = ["run", script_file(TAUBIN), "-i", cube, "-o", "out.ply", "--json", "pipe.jsonl"]
    unread = call(*arguments)
    assert (unread.exit_code, unread.stderr) == (
        1,
        "Error: cannot write pipe.jsonl: nobody reads from this pipe\n",
    )
    refused = call(*arguments, "--resume")
    assert refused.exit_code == 2
    assert refused.stderr.startswith("Error: pipe.jsonl is no file, so no batch can go on from it")
    with subprocess.Popen(["cat", "pipe.jsonl"], stdout=subprocess.PIPE) as reader:
        # It waits for a writer, which opens the pipe only if there is a reader.
        with open("pipe.jsonl", "w", encoding="utf-8"):
            written = call(*arguments)
        lines = reader.communicate()[0].splitlines()
    assert written.exit_code == 0, written.stderr
    assert json.loads(lines[1])["input"] == "cube.ply"


@pytest.mark.parametrize(
    "line", ['{"input": 1}', '{"begun": 1}', '{"input": "a", "status": "done", "outputs": [1]}']
)
def test_lines_of_other_programs_are_refused(line):
    Path("other.jsonl").write_text(f"{line}\n")
    result = call("summary", "other.jsonl")
    assert result.exit_code == 2
    assert result.stderr == "Error: other.jsonl holds no records of a batch; use a new name\n"


def test_summary_of_other_files_is_refused(cube):
    assert call("summary", cube).stderr == (
        "Error: cube.ply holds no records of a batch; use a new name\n"
    )
    assert call("summary", "no.jsonl").exit_code == 2


# --- records on the standard output --------------------------------------------------------------


@pytest.mark.parametrize("command", ["run", "flip"])
@pytest.mark.slow
def test_records_on_the_standard_output_and_nothing_else(command):
    cube_file("one.ply")
    Path("bad.ply").write_text("no mesh")
    inputs = ["-i", "*.ply", "-o"] if command == "run" else ["*.ply"]
    done = spawn(command, *inputs, "{name}.off", "--json", "-", "--summary", "--workers", 1)
    assert done.returncode == 1
    records = [json.loads(line) for line in done.stdout.splitlines()]
    assert {r["input"]: r["status"] for r in records if "input" in r} == {
        "one.ply": "done",
        "bad.ply": "bad file",
    }
    assert "\n2 inputs: " in done.stderr
    assert listing() == ["bad.ply", "one.off", "one.ply"]


def test_measure_takes_the_standard_output_too():
    cube_file("one.ply")
    assert call("measure", "one.ply", "--json", "-").stdout == call("measure", "one.ply",
                                                                    "--json").stdout  # fmt: skip
    assert json.loads(call("measure", "--json", "-", "one.ply").stdout)[0]["faces"] == 24
    assert listing() == ["one.ply"]


def test_no_batch_goes_on_from_the_standard_output():
    cube_file("one.ply")
    result = call("flip", "one.ply", "a.ply", "--json", "-", "--resume")
    assert result.exit_code == 2
    assert "so no batch can go on from it; name a file" in result.stderr


# --- dry runs ------------------------------------------------------------------------------------


@pytest.mark.usefixtures("workers_here")
def test_dry_run_makes_no_folders():
    Path("in/deep").mkdir(parents=True)
    Path("out").mkdir()
    cube_file("in/deep/one.ply")
    arguments = ["run", script_file(TAUBIN), "-i", "in/**/*.ply", "-o", "out/{dir}/{name}.off"]
    result = call(*arguments, "--dry-run")
    assert (result.exit_code, result.stderr) == (0, "")
    assert (
        result.stdout == "in/deep/one.ply: ok; 1 step to run, then out/in/deep/one.off to write\n"
    )
    assert listing("out") == []
    wrong = call(*arguments[:-1], "out/{dir}/{name}.fbx", "--dry-run")
    assert wrong.exit_code == 2
    assert wrong.stderr.startswith("Error: the format of out/in/deep/one.fbx is unknown")
    assert listing("out") == []
    assert call(*arguments).exit_code == 0
    assert listing("out/in/deep") == ["one.off"]
    # Where the folder is there, its files are found.
    assert "already exists" in call(*arguments, "--dry-run").stderr


# --- odd names -----------------------------------------------------------------------------------


@pytest.mark.usefixtures("workers_here")
@pytest.mark.skipif(os.name == "nt", reason="such a name can't be")
def test_a_line_break_in_a_name_breaks_no_line():
    cube_file("a\nb.ply")
    Path("c\nd.ply").write_text("no mesh")
    arguments = ["-i", "*.ply", "-o", "{name}.off", "--log", "log.txt", "--summary"]
    result = call("run", script_file(TAUBIN), *arguments)
    assert result.stdout.startswith("a?b.ply -> a?b.off (14 vertices, 24 faces): 1 step, ")
    assert len(result.stdout.splitlines()) == 1 + len(call_summary(result))
    assert result.stderr.startswith("Error: cannot read c d.ply: ")
    assert len(result.stderr.splitlines()) == 2
    assert not [line for line in Path("log.txt").read_text().splitlines() if line[:1] == "b"]
    assert len(call("flip", "a\nb.ply", "out.off").stdout.splitlines()) == 1
    dry = call("run", script_file(TAUBIN), "-i", "a\nb.ply", "--dry-run")
    assert dry.stdout == "a?b.ply: ok; 1 step to run, then no file to write\n"


def call_summary(result):
    """The lines of the summary in what was printed."""
    lines = result.stdout.splitlines()
    return lines[next(i for i, line in enumerate(lines) if line.startswith("2 inputs: ")) :]
