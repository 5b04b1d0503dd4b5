"""`--report`: pages on meshes before and after, and on a batch."""

from __future__ import annotations

from pathlib import Path
from typing import NamedTuple

from ..batch.jobs import check_page
from ..batch.shards import Shard
from ..mesh_files.paths import Output
from ..messages import WrongUse
from .completion import files
from .kept import kept_option, kept_options

_ENDINGS = (".html", ".htm")


class Reports(NamedTuple):
    """The page of each mesh, a pattern if there are several; and the page of all."""

    page: Output | None = None
    table: Path | None = None


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
    """The pages that were asked for.

    With `is_several` there may be several meshes: then a name without a placeholder is that of
    their table, as it always is beside one with a placeholder. Raises `WrongUse` if a name can't be
    that of a page, or exists and `force` is false (unless it is a report page, and an earlier batch
    goes on, `is_continued`), or is that of the tables of all shares; a name with a
    placeholder is checked when that is filled in.
    """
    page, table = None, None
    names = kept_options().get("reports", ())
    is_several = is_several or len(names) > 1
    for name in names:
        if not name.lower().endswith(_ENDINGS):
            raise WrongUse(f"--report {name}: a page needs a name such as report.html")
        output = Output(name if shard is None else shard.in_name(name))
        is_table = is_several and not output.has_placeholder
        if (table if is_table else page) is not None:
            what = "the table of all meshes" if is_table else "the page of a mesh"
            raise WrongUse(f"--report {name}: {what} has a name already; name it once")
        if is_table:
            if shard is not None:
                shard.check_table(name)
            check_page(output.path, force, is_continued)
            table = output.path
        else:
            page = output
    return Reports(page, table)
