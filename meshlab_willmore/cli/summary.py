"""`meshlab-willmore summary`: the files of records of a batch, put together."""

from __future__ import annotations

import json
from collections import Counter
from pathlib import Path

import click

from ..batch import records
from ..batch.summary import Summary
from ..mesh_files.paths import matches
from ..messages import WrongUse
from .arguments import json_option
from .completion import files
from .errors import debug_option
from .text import in_window

EXAMPLES = """\b
Examples:
  meshlab-willmore summary log.jsonl
  meshlab-willmore summary 'shard-*.jsonl'
"""


@click.command("summary", short_help="Summarise records of batches.", epilog=EXAMPLES)
@click.argument("files", metavar="FILE.jsonl...", nargs=-1, required=True, shell_complete=files)
@json_option
@debug_option
def command(files: tuple[str, ...], as_json: bool) -> None:
    """Count outcomes in the files that --json of 'run', 'flip' and 'measure' has written.

    Of an input that was processed several times, the last record counts. Failures are listed with
    their reason. Exit code 1 if an input failed.
    """
    paths = [path for name in files for path in matches(name)]
    results: dict[str, records.Result] = {}
    for path in paths:
        results.update(_records(path))
    summary = Summary()
    for result in results.values():
        summary.add(result)
    if as_json:
        counts = Counter(result.status for result in results.values())
        failed = [r.as_json() for r in results.values() if not r.is_done]
        click.echo(json.dumps({"counts": counts, "failed": failed}, indent=2))
    else:
        click.echo(in_window(summary.lines()))
    if summary.failed:
        click.get_current_context().exit(1)


def _records(path: Path) -> dict[str, records.Result]:
    if not path.is_file():
        raise WrongUse(f"there is no file {path}")
    try:
        return records.read(path).results
    except OSError as error:
        raise OSError(f"cannot read {path}: {error.strerror}") from error
