"""Faults of files, scripts, sets of meshes and the command line."""

from . import Fault

READ = "tests/mlx/test_read.py tests/mlx/test_broken.py"
RICH = "tests/mlx/test_rich.py tests/mlx/test_broken_values.py"
CHECK = "tests/meshset/test_check.py"
RECORDING = "tests/meshset/test_recording.py"

FILES = [
    Fault(
        "special files are replaced",
        "files.py",
        "    refuse_special(target)\n",
        "",
        "tests/test_files.py tests/mesh_files/test_saving.py",
    ),
    Fault(
        "a link is replaced, not its file",
        "files.py",
        "return Path(os.path.realpath(path)) if path.is_symlink() else path",
        "return path",
        "tests/test_files.py",
    ),
    Fault(
        "a replaced file loses its mode",
        "files.py",
        "        shutil.copymode(place, source)",
        "        pass",
        "tests/test_files.py",
    ),
    Fault(
        "a pipe that nobody reads from blocks",
        "files.py",
        'getattr(os, "O_NOCTTY", 0) | getattr(os, "O_NONBLOCK", 0)',
        'getattr(os, "O_NOCTTY", 0)',
        "tests/cli/test_runlog.py",
    ),
]

SCRIPTS = [
    Fault(
        "a parameter may be given twice",
        "mlx/read.py",
        "        elif not is_new:\n            self.add(",
        "        elif False:\n            self.add(",
        READ,
    ),
    Fault(
        "text between elements is overlooked",
        "mlx/read.py",
        "not self._has_text and not content.isspace()",
        "not self._has_text and content is None",
        READ,
    ),
    Fault(
        "declarations are read",
        "mlx/read.py",
        "        if self.parser.declares:",
        "        if False:",
        READ,
    ),
    Fault(
        "depth has no end",
        "mlx/read.py",
        "if len(self._open) == DEEPEST:",
        "if len(self._open) == 100 * DEEPEST:",
        READ,
    ),
    Fault(
        "a script is read in one encoding only",
        "mlx/decode.py",
        "encoding = marked or _declared(data)",
        'encoding = marked or "utf-8"',
        READ,
    ),
    Fault(
        "False is false",
        "mlx/rich.py",
        '    if text == "false":\n',
        '    if text.lower() == "false":\n',
        RICH,
    ),
    Fault(
        "a number may be too close to zero",
        "mlx/rich.py",
        "if abs(value) <= SMALLEST_FLOAT and _NOT_ZERO.match(number):",
        "if abs(value) < SMALLEST_FLOAT and _NOT_ZERO.match(number):",
        RICH,
    ),
    Fault(
        "a percentage may be above 100",
        "mlx/rich.py",
        "if not 0 <= percent <= 100:",
        "if not 0 <= percent:",
        RICH,
    ),
    Fault(
        "line breaks are written as they are",
        "mlx/write.py",
        '        "\\n": "&#10;",\n',
        "",
        "tests/mlx/test_write.py",
    ),
    Fault(
        "an enum's choices are those of the script",
        "meshset/check.py",
        "return details if is_there else (*kept, *choices)",
        "return details",
        "tests/cli/test_convert.py",
    ),
]

SETS = [
    Fault(
        "ids are not checked",
        "meshset/check.py",
        "            self._check_id(own, value)\n",
        "",
        CHECK + " tests/test_script.py",
    ),
    Fault(
        "a required parameter may be missing",
        "meshset/check.py",
        "if own.required and own.keyword not in",
        "if False and own.keyword not in",
        CHECK,
    ),
    Fault(
        "deleted meshes are still there",
        "meshset/check.py",
        "        self._left -= known.name == _DELETE\n",
        "",
        CHECK + " tests/test_script.py",
    ),
    Fault(
        "our steps come last in a script",
        "meshset/recording.py",
        "return [*entries, *unnoted] if has_steps else [*unnoted, *entries]",
        "return [*unnoted, *entries]",
        RECORDING,
    ),
    Fault(
        "a script keeps physical ids",
        "meshset/recording.py",
        "    if not ids:\n        return step",
        "    if True:\n        return step",
        RECORDING,
    ),
    Fault(
        "helper layers count",
        "meshset/ids.py",
        "return mesh_id - bisect_left(used, mesh_id)",
        "return mesh_id",
        "tests/meshset/test_ids.py",
    ),
    Fault(
        "held meshes are not noticed",
        "meshset/layers.py",
        "return alone and not _is_held(ms, native.ids(ms)[0])",
        "return alone",
        "tests/meshset/test_layers.py",
    ),
    Fault(
        "selected sides stay where they were",
        "meshset/edge_flags.py",
        "flags[changed] = (flags[changed] & ~mask) | bits",
        "flags[changed] = flags[changed] | bits",
        "tests/meshset/test_edge_flags.py",
    ),
    Fault(
        "inner edges of polygons are free",
        "meshset/edge_flags.py",
        "fixed = faux | faux.any(axis=1, keepdims=True)",
        "fixed = faux & False",
        "tests/meshset/test_edge_flags.py",
    ),
    Fault(
        "what PyMeshLab drops is not noticed",
        "meshset/exchange.py",
        "return [what for what, holds in checks.items() if not holds()]",
        "return []",
        "tests/meshset/test_exchange.py",
    ),
    Fault(
        "texture coordinates are not moved",
        "meshset/exchange.py",
        "wedges[corners.ravel()].reshape(-1, 6)",
        "wedges.reshape(-1, 6)",
        "tests/meshset/test_textures.py",
    ),
]

COMMANDS = [
    Fault(
        "existing outputs are replaced without --force",
        "mesh_files/paths.py",
        "if os.path.lexists(path) and not force:",
        "if False:",
        "tests/cli/test_run.py tests/mesh_files/test_saving.py",
    ),
    Fault(
        "two outputs may have one name",
        "batch/jobs.py",
        "            if other is not None:",
        "            if False:",
        "tests/cli/test_run.py",
    ),
    Fault(
        "an input may be replaced by the result of another",
        "batch/jobs.py",
        "if readers.get(key, source) != source:",
        "if False:",
        "tests/cli/test_run.py",
    ),
    Fault(
        "a bad input ends a batch",
        "batch/jobs.py",
        "            index += not isinstance(problem, NoMatchError)\n",
        "            if problem:\n                raise problem\n",
        "tests/mesh_files/test_loading.py",
    ),
    Fault(
        "a full disk is not noticed",
        "mesh_files/saving.py",
        "            file.write(bytes(_ROOM))",
        "            pass",
        "tests/mesh_files/test_saving.py",
    ),
    Fault(
        "after an error new files stay",
        "mesh_files/saving.py",
        "                file.unlink(missing_ok=True)",
        "                pass",
        "tests/mesh_files/test_saving.py",
    ),
    Fault(
        "the exit code of a signal is 1",
        "cli/errors.py",
        "ctx.exit(SIGNAL_EXIT + caught[0])",
        "ctx.exit(1)",
        "tests/cli/test_errors.py",
    ),
    Fault(
        "a log may be written over anything",
        "cli/runlog.py",
        "    if beginning and not _BEGINNING.match(beginning):",
        "    if False:",
        "tests/cli/test_runlog.py",
    ),
    Fault(
        "names are measured by letters",
        "cli/text.py",
        'return 2 if unicodedata.east_asian_width(letter) in "WF" else 1',
        "return 1",
        "tests/cli/test_text.py tests/cli/test_progress.py",
    ),
    Fault(
        "JSON has numbers that are none",
        "batch/steplog.py",
        "return value if math.isfinite(value) else None",
        "return value",
        "tests/cli/test_measure.py tests/cli/test_compare.py",
    ),
]

BATCHES = [
    Fault(
        "children of a hung worker live on",
        "batch/process.py",
        "os.killpg(self._process.pid, signal.SIGKILL)",
        "self._process.kill()",
        "tests/batch/test_pool.py",
    ),
    Fault(
        "a mesh is blamed for what others left behind",
        "batch/pool.py",
        "if ended.status in (CRASH, MEMORY) and not is_fresh and not self._is_closed:",
        "if False:",
        "tests/batch/test_pool.py",
    ),
    Fault(
        "what a killed worker was writing stays",
        "batch/pool.py",
        "                    remove_drafts(Path(folder), worker.mark)",
        "                    pass",
        "tests/batch/test_pool.py",
    ),
    Fault(
        "memory has no limit",
        "batch/worker.py",
        "with memory.limited(limit if task.is_limited else None):",
        "with memory.limited(None):",
        "tests/batch/test_pool.py",
    ),
    Fault(
        "half an output counts as done",
        "batch/records.py",
        "os.path.isfile(saved.file) and os.path.getsize(saved.file) == saved.bytes",
        "os.path.isfile(saved.file)",
        "tests/batch/test_runner.py",
    ),
    Fault(
        "what another script did counts as done",
        "batch/records.py",
        "result.recipe != recipe or ",
        "",
        "tests/batch/test_runner.py",
    ),
    Fault(
        "a file of the user is replaced when a batch goes on",
        "batch/resuming.py",
        "check_output(output.path, force or is_own(output.path))",
        "check_output(output.path, True)",
        "tests/batch/test_runner.py",
    ),
    Fault(
        "shares differ from process to process",
        "batch/shards.py",
        'int.from_bytes(digest, "big") % self.of',
        "hash(name) % self.of",
        "tests/batch/test_shards.py",
    ),
]

PROGRESS = [
    Fault(
        "progress falls in a stage",
        "progress.py",
        "whole = max(inner.reached, min(fraction, 1.0))",
        "whole = min(fraction, 1.0)",
        "tests/test_progress.py",
    ),
    Fault(
        "a stage does not end where the next begins",
        "progress.py",
        "around.reached = max(around.reached, end)",
        "pass",
        "tests/test_progress.py",
    ),
    Fault(
        "progress is called without pause",
        "progress.py",
        "self._due = time.monotonic() + self._seconds",
        "pass",
        "tests/test_progress.py",
    ),
    Fault(
        "a value that is not False stops a run",
        "progress.py",
        'return type(answer).__name__ in ("bool", "bool_") and not answer',
        "return answer is not None and not answer",
        "tests/test_progress.py",
    ),
    Fault(
        "a callable is heard by itself",
        "progress.py",
        "listener, _here.listener = current(), None",
        "listener = current()",
        "tests/test_progress.py",
    ),
    Fault(
        "a stop is an error of the filter",
        "meshset/filter.py",
        "            if was_raised_by_listener(error):\n                raise\n",
        "",
        "tests/meshset/test_progress.py",
    ),
    Fault(
        "a stop is an error of the step",
        "meshset/play.py",
        "        if was_raised_by_listener(error):\n            raise\n",
        "",
        "tests/meshset/test_progress.py",
    ),
    Fault(
        "what ended while a batch was stopped is not recorded",
        "batch/runner.py",
        "                stack.callback(self._record_left_over, own)\n",
        "",
        "tests/batch/test_progress.py",
    ),
]

FAULTS = [*FILES, *SCRIPTS, *SETS, *COMMANDS, *BATCHES, *PROGRESS]
