"""Shares of a batch: each input is in exactly one."""

import pytest

from meshlab_willmore.batch.shards import Shard, shard_of
from meshlab_willmore.messages import WrongUse


def test_each_input_is_in_one_share_whatever_others_there_are():
    shards = [shard_of(f"{number}/7") for number in range(1, 8)]
    names = [f"scans/{number}.ply" for number in range(500)]
    owners = {name: [shard for shard in shards if shard.has(name)] for name in names}
    assert all(len(owner) == 1 for owner in owners.values())
    sizes = [sum(shard.has(name) for name in names) for shard in shards]
    assert min(sizes) > 40
    # Not by Python's hash, which differs from process to process.
    assert [Shard(3, 32).has(f"scans/{number}.ply") for number in (31, 32, 33, 69)] == [
        False,
        True,
        False,
        True,
    ]


def test_shares_of_numbered_names_are_about_as_large():
    names = [f"{number}.ply" for number in range(320)]
    sizes = [sum(Shard(number, 32).has(name) for name in names) for number in range(1, 33)]
    assert min(sizes) > 2
    assert max(sizes) < 20


@pytest.mark.parametrize(
    ("variables", "shard"),
    [
        ({"SLURM_ARRAY_TASK_ID": "5", "SLURM_ARRAY_TASK_COUNT": "8"}, Shard(6, 8)),
        (
            {
                "SLURM_ARRAY_TASK_ID": "14",
                "SLURM_ARRAY_TASK_MIN": "10",
                "SLURM_ARRAY_TASK_STEP": "2",
                "SLURM_ARRAY_TASK_COUNT": "4",
            },
            Shard(3, 4),
        ),
        ({"JOB_COMPLETION_INDEX": "0", "JOB_COMPLETIONS": "3"}, Shard(1, 3)),
    ],
)
def test_variables_of_schedulers(variables, shard):
    assert shard_of("auto", variables) == shard


@pytest.mark.parametrize(
    ("text", "variables", "line"),
    [
        ("0/3", {}, "--shard 0/3: it must be I/N with I from 1 to N"),
        ("4/3", {}, "--shard 4/3: it must be"),
        ("half", {}, "--shard half: it must be"),
        ("auto", {}, "neither SLURM_ARRAY_TASK_ID (SLURM) nor JOB_COMPLETION_INDEX"),
        ("auto", {"JOB_COMPLETION_INDEX": "1"}, "the variable JOB_COMPLETIONS is not set"),
        ("auto", {"JOB_COMPLETION_INDEX": "3", "JOB_COMPLETIONS": "3"}, "JOB_COMPLETIONS 3"),
        ("auto", {"SLURM_ARRAY_TASK_ID": "x", "SLURM_ARRAY_TASK_COUNT": "2"}, "is 'x', which is"),
    ],
)
def test_wrong_shares_are_named(text, variables, line):
    with pytest.raises(WrongUse) as caught:
        shard_of(text, variables)
    assert line in str(caught.value)
