"""The pages of the documentation, and the code on them."""

import re
from pathlib import Path
from typing import NamedTuple

ROOT = Path(__file__).parents[2]
DOCS = ROOT / "docs"
README = ROOT / "README.md"
# Only made when the site is built.
GENERATED = ("_build", "gallery")

# A fence, and what a comment right above it says.
FENCE = re.compile(
    r"^(?P<indent> *)(?:<!-- (?P<note>[^\n]*) -->\n *)?"
    r"```(?P<language>[^\n]*)\n(?P<text>.*?)^ *```$",
    re.MULTILINE | re.DOTALL,
)
LANGUAGES = ("python", "sh", "text")
# What a comment above a block of code may say. `.ci/run` runs commands, and tests of their own run
# examples by name.
NOT_RUN = "not run: "
COMMAND = "command: "
EXAMPLE = "example: "
PRINTED = "printed by the block above"


class Block(NamedTuple):
    """A block of code, or what one prints: its language, its text, and the comment above it."""

    language: str
    text: str
    note: str

    @property
    def runs(self):
        """Whether it runs as it is; of the others, the comment says why not."""
        return self.language != "text" and not self.note.startswith((NOT_RUN, COMMAND, EXAMPLE))


def pages():
    """README and all Markdown files of the site, which others write too."""
    found = [
        path
        for path in sorted(DOCS.rglob("*.md"))
        if path.relative_to(DOCS).parts[0] not in GENERATED
    ]
    return [README, *found]


def name_of(page):
    return page.relative_to(ROOT).as_posix()


def blocks(page):
    """The blocks of Python, of the shell and of text on a page, with those that it includes."""
    found = []
    for fence in FENCE.finditer(page.read_text(encoding="utf-8")):
        language, text = fence["language"].strip(), fence["text"]
        if language.startswith("{include}"):
            found += included(page.parent / language.removeprefix("{include}").strip(), text)
        elif language in LANGUAGES:
            found.append(
                Block(language, without_indent(text, fence["indent"]), fence["note"] or "")
            )
    return found


def included(page, options):
    """The blocks of a part of a page, or of all of it."""
    limits = dict(re.findall(r'^:(start-after|end-before): "(.*)"$', options, re.MULTILINE))
    if page.suffix != ".md" or not limits:
        return []
    text = page.read_text(encoding="utf-8").partition(limits["start-after"])[2]
    assert text, f"{page.name} has no {limits['start-after']}"
    text = text.partition(limits["end-before"])[0]
    return [block for block in blocks(page) if block.text in text]


def without_indent(text, indent):
    return "".join(line.removeprefix(indent) for line in text.splitlines(keepends=True))
