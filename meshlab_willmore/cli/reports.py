"""`--report`: pages on meshes before and after, and on a batch."""

from __future__ import annotations

from ..batch.jobs import Reports, reports_of
from ..batch.shards import Shard
from ..messages import WrongUse
from .arguments import kept_option, kept_options
from .completion import files

_ENDINGS = (".html", ".htm")


report_option = kept_option(
    "--report",
    "reports",
    multiple=True,
    metavar="PAGE.html",
    shell_complete=files,
    help="Write a page for a browser: before and after in 3D and in numbers. For several meshes it "
    "is a table; with a placeholder, as in 'pages/{name}.html', each mesh has a page. Can be given "
    "twice, for both.",
)


def check_reports(
    is_several: bool, force: bool, shard: Shard | None = None, is_continued: bool = False
) -> Reports:
    """The pages that were asked for; see `meshlab_willmore.batch.jobs.reports_of`."""
    names = kept_options().get("reports", ())
    for name in names:
        if not name.lower().endswith(_ENDINGS):
            raise WrongUse(f"--report {name}: a page needs a name such as report.html")
    return reports_of(names, is_several, force, shard, is_continued)
