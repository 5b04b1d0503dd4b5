"""`meshlab-willmore doctor`: whether this machine is fit."""

from __future__ import annotations

import json
from typing import TYPE_CHECKING

import click

from . import progress
from .errors import debug_option

if TYPE_CHECKING:
    from .checks import Finding

EXAMPLES = """\b
Examples:
  meshlab-willmore doctor
  meshlab-willmore doctor --json
"""


@click.command("doctor", short_help="Tell whether this machine is fit.", epilog=EXAMPLES)
@click.option("--json", "as_json", is_flag=True, help="Print JSON for machines.")
@debug_option
def command(as_json: bool) -> None:
    """Look at what this package needs, and name the command that mends what is missing.

    Libraries, PyMeshLab's plugins and the filters gone with them, Numba's variables, compiler and
    cache folder, room for temporary files. Exit code 0 if all is fit, else 1.
    """
    from .checks import ALL

    findings = []
    with progress.shown("doctor", len(ALL)) as status:
        for check in ALL:
            status.next(getattr(check, "__name__", ""))
            finding = check()
            findings.append(finding)
            if not as_json:
                click.echo(_shown(finding))
    wrong = sum(not finding.ok for finding in findings)
    if as_json:
        click.echo(json.dumps({"fit": not wrong, "findings": [f._asdict() for f in findings]}))
    else:
        click.echo(f"{wrong} of {len(findings)} checks failed" if wrong else "This machine is fit.")
    if wrong:
        click.get_current_context().exit(1)


def _shown(finding: Finding) -> str:
    line = f"{'ok ' if finding.ok else 'BAD'}  {finding.name}: {finding.text}"
    return line if finding.ok else f"{line}\n     mend it: {finding.cure}"
