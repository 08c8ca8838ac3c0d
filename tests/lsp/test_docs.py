"""What the page on editors tells people to write."""

from __future__ import annotations

import ast
import re
import shlex
import sys
from pathlib import Path
from typing import Any

from deros.metamodels.languages import LANGUAGES, suffixes
from tests.support import pages
from tests.support.cli import deros

if sys.version_info >= (3, 11):
    import tomllib
else:
    import tomli as tomllib

BLOCKS = {block.language: block.text for block in pages.blocks() if block.page == "docs/editors.md"}
SHELL = "bash"
ENDINGS = {suffix.removeprefix(".") for suffix in suffixes()}


def starts(command: list[str]) -> bool:
    """Return whether a command is one of ours."""
    return command[0] == "deros" and deros(*command[1:], "--help").code == 0


def test_what_is_installed_is_declared() -> None:
    """The extra of the command is one of the package."""
    *_, wanted = shlex.split(BLOCKS[SHELL])
    extra = re.fullmatch(r"deros\[(\w+)\]", wanted)
    assert extra is not None
    project: Any = tomllib.loads(Path("pyproject.toml").read_text(encoding="utf-8"))["project"]
    assert any(each.startswith("pygls") for each in project["optional-dependencies"][extra[1]])


def test_neovim_starts_the_server_for_each_language() -> None:
    """The names of file types are those of the languages."""
    text = BLOCKS["lua"]
    endings = re.search(r"extension = {(.*?)}", text)
    command = re.search(r"cmd = {(.*?)}", text)
    assert endings is not None
    assert command is not None
    named = dict(re.findall(r"(\w+) = \"(\w+)\"", endings[1]))
    assert named == {each.suffix.removeprefix("."): each.name for each in LANGUAGES}
    assert starts(list(ast.literal_eval(f"({command[1]},)")))
    assert text.count("{") == text.count("}")


def test_helix_starts_the_server_for_each_language() -> None:
    """The server that the language names is there."""
    settings = tomllib.loads(BLOCKS["toml"])
    (language,) = settings["language"]
    assert set(language["file-types"]) == ENDINGS
    server = settings["language-server"][language["language-servers"][0]]
    assert starts([server["command"], *server["args"]])


def test_emacs_starts_the_server_for_each_language() -> None:
    """The expression for file names takes all of them."""
    text = BLOCKS["lisp"]
    assert text.count("(") - text.count("\\\\(") == text.count(")") - text.count("\\\\)")
    pattern = re.search(r"auto-mode-alist '\(\"(.*?)\"", text)
    assert pattern is not None
    found = pattern[1].replace("\\\\", "\\").replace("\\(", "(").replace("\\)", ")")
    found = found.replace("\\|", "|").replace("\\'", "$")
    assert all(re.search(found, f"robot.{ending}") for ending in ENDINGS)
    assert not re.search(found, "robot.txt")
    command = re.search(r"deros-mode \. \((.*?)\)", text)
    assert command is not None
    assert starts(shlex.split(command[1]))


def test_no_block_is_hidden_by_another() -> None:
    """Each is the only one of its language on the page, so all are looked at."""
    of_page = [each.language for each in pages.blocks() if each.page == "docs/editors.md"]
    assert len(of_page) == len(BLOCKS) > 0
