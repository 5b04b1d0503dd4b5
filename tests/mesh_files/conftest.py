"""The folder and the helpers of the tests of commands, which read and write mesh files too."""

from tests.cli.conftest import _folder, _quick_machine, cube  # noqa: F401
from tests.workers import workers_here  # noqa: F401
