"""`meshlab-willmore completion`: what makes a shell complete commands, options, names and files."""

from __future__ import annotations

import glob
from typing import Any

import click
from click.shell_completion import (
    BashComplete,
    CompletionItem,
    FishComplete,
    ShellComplete,
    ZshComplete,
    add_completion_class,
)

from .errors import debug_option
from .scripts import shipped_scripts

# Of the variable by which a shell asks for completions; click derives it from the program's name.
_VARIABLE = "_MESHLAB_WILLMORE_COMPLETE"
_PROGRAM = "meshlab-willmore"

EXAMPLES = """\b
Examples:
  meshlab-willmore completion bash > ~/.meshlab-willmore.bash
  meshlab-willmore completion zsh > ~/.zfunc/_meshlab-willmore
  meshlab-willmore completion fish > meshlab-willmore.fish
"""


class _Bash(BashComplete):
    """Quotes values with blanks: click's own script takes them apart.

    Bash gives ``--option=value`` as three words, of which ``=`` is left out.
    """

    source_template = """\
%(complete_func)s() {
    local type value
    COMPREPLY=()
    while IFS=',' read -r type value; do
        case $type in
            dir) compopt -o dirnames ;;
            file) compopt -o default ;;
            plain) COMPREPLY+=("$value") ;;
        esac
    done < <(IFS=$'\\n'; env COMP_WORDS="${COMP_WORDS[*]}" COMP_CWORD=$COMP_CWORD \\
        %(complete_var)s=bash_complete "$1")
    # Bash quotes what it takes for names of files.
    compopt -o filenames
}

complete -o nosort -F %(complete_func)s %(prog_name)s
"""

    def get_completion_args(self) -> tuple[list[str], str]:
        """The words before the cursor, and the one at it."""
        words, incomplete = super().get_completion_args()
        pairs = zip(["", *words], words, strict=False)
        return [word for last, word in pairs if word != "=" or last[:2] != "--"], incomplete


class _Zsh(ZshComplete):
    """Keeps the name of an option before ``=``: click's own script replaces the whole word."""

    source_template = ZshComplete.source_template.replace(
        "    for type key descr",
        "    [[ $words[CURRENT] == --*=* ]] && compset -P 1 '*='\n    for type key descr",
    ).replace("compadd -U", 'compadd -U -i "$IPREFIX"')


class _Fish(FishComplete):
    """Keeps values with commas whole."""

    source_template = FishComplete.source_template.replace(
        'string split "," $completion', 'string split -m 1 "," $completion'
    )


SHELLS: dict[str, type[ShellComplete]] = {"bash": _Bash, "fish": _Fish, "zsh": _Zsh}
for _shell in SHELLS.values():
    add_completion_class(_shell)


@click.command("completion", short_help="Complete words in the shell.", epilog=EXAMPLES)
@click.argument("shell", type=click.Choice([*SHELLS]))
@debug_option
def command(shell: str) -> None:
    """Print a script with which SHELL completes commands, options, their values and files.

    bash: add the line 'source ~/.meshlab-willmore.bash' to ~/.bashrc, or, where the package
    bash-completion is installed, write the script into
    ~/.local/share/bash-completion/completions/meshlab-willmore.

    zsh: the folder of the script has to be in fpath before compinit is called in ~/.zshrc:
    'fpath+=~/.zfunc; autoload -Uz compinit; compinit'.

    fish: the script belongs into ~/.config/fish/completions.
    """
    group = click.get_current_context().find_root().command
    click.echo(SHELLS[shell](group, {}, _PROGRAM, _VARIABLE).source())


# --- what completes ------------------------------------------------------------------------------


def files(_: click.Context, __: click.Parameter, incomplete: str) -> list[CompletionItem[Any]]:
    """Names of files and folders, by the shell itself."""
    return [CompletionItem(incomplete, type="file")]


def folders(_: click.Context, __: click.Parameter, incomplete: str) -> list[CompletionItem[Any]]:
    """Names of folders, by the shell itself."""
    return [CompletionItem(incomplete, type="dir")]


def scripts(ctx: click.Context, param: click.Parameter, incomplete: str) -> Any:
    """Files, or the shipped scripts where no file has such a name."""
    names = [name for name in shipped_scripts() if name.startswith(incomplete)]
    is_file = bool(glob.glob(f"{glob.escape(incomplete)}*"))
    return files(ctx, param, incomplete) if is_file or not names else names


def shipped(_: click.Context, __: click.Parameter, incomplete: str) -> list[str]:
    """The shipped scripts."""
    return [name for name in shipped_scripts() if name.startswith(incomplete)]


def filters(_: click.Context, __: click.Parameter, incomplete: str) -> list[str]:
    """The names of filters: PyMeshLab's, and those of MeshLab that begin in the same way."""
    from ..meshset.catalogue import everything

    known = everything()
    names = [info.name for info in known]
    if incomplete:
        names += [info.meshlab_name for info in known]
    return sorted({name for name in names if name.startswith(incomplete)} - {""})
