"""The page for contributors lists the rooms that there are."""

import re

from .pages import DOCS, ROOT


def test_all_rooms_are_listed():
    text = (DOCS / "contributing.md").read_text(encoding="utf-8")
    listed = re.search(r"^## The rooms$.*?^```text\n(.*?)^```$", text, re.MULTILINE | re.DOTALL)[1]
    names = [line[:21] for line in listed.splitlines()]
    found = {name for cell in names for name in re.findall(r"\w+", cell)}
    pyproject = (ROOT / "pyproject.toml").read_text(encoding="utf-8")
    layers = re.search(r"^layers = \[\n(.*?)^\]$", pyproject, re.MULTILINE | re.DOTALL)[1]
    rooms = {room for cell in re.findall(r'"(.*)"', layers) for room in cell.split(" | ")}
    assert found == rooms
