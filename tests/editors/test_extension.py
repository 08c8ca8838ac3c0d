"""What the extension for VS Code declares is what deros has."""

from __future__ import annotations

import json
import re
from pathlib import Path
from typing import Any

import pytest

from deros.lsp.features.lenses import RUN
from deros.metamodels.languages import LANGUAGES
from tests.support.needs import may_run
from tools import vscode
from tools.vscode import SOURCE

PACKAGE: Any = json.loads((SOURCE / "package.json").read_text(encoding="utf-8"))
CONTRIBUTED: Any = PACKAGE["contributes"]


def test_languages_are_those_of_the_metamodels() -> None:
    """Ids and suffixes are ours, and each of them starts the extension."""
    declared = {each["id"]: each["extensions"] for each in CONTRIBUTED["languages"]}
    assert declared == {each.name: [each.suffix] for each in LANGUAGES}
    assert PACKAGE["activationEvents"] == [f"onLanguage:{name}" for name in declared]
    program = (SOURCE / "src/program.ts").read_text(encoding="utf-8")
    served = re.search(r"LANGUAGES = (\[.*\]);", program)
    assert served is not None
    assert json.loads(served[1]) == list(declared)


def test_files_that_are_named_are_there() -> None:
    """Each language has its grammar, under the name that the grammar has."""
    scopes = {each["language"]: each["scopeName"] for each in CONTRIBUTED["grammars"]}
    assert list(scopes) == [each.name for each in LANGUAGES]
    for each in CONTRIBUTED["grammars"]:
        grammar = json.loads((SOURCE / each["path"]).read_text(encoding="utf-8"))
        assert grammar["scopeName"] == each["scopeName"]
    for each in CONTRIBUTED["languages"]:
        assert "brackets" in json.loads((SOURCE / each["configuration"]).read_text("utf-8"))


def test_client_has_the_command_of_the_lenses() -> None:
    """The server names a command that the client registers; people see the other one."""
    text = (SOURCE / "src/extension.ts").read_text(encoding="utf-8")
    commands = dict(re.findall(r'const (\w+) = "(deros\.\w+)";', text))
    assert commands["RUN"] == RUN
    assert [each["command"] for each in CONTRIBUTED["commands"]] == [commands["RESTART"]]
    assert all(f"registerCommand({name}," in text for name in commands)


@pytest.mark.parametrize("page", [SOURCE / "README.md", Path("docs/editors.md")], ids=str)
def test_settings_are_explained(page: Path) -> None:
    """Each has its row where people read about the extension, and there is no other."""
    named = re.findall(r"^\| `(deros\.[\w.]+)` \|", page.read_text(encoding="utf-8"), re.M)
    assert named == list(CONTRIBUTED["configuration"]["properties"])


def test_folder_that_is_not_trusted_chooses_no_program() -> None:
    """A setting that a folder may bring along, and that decides what runs, waits for trust."""
    trust = PACKAGE["capabilities"]["untrustedWorkspaces"]
    properties = CONTRIBUTED["configuration"]["properties"]
    decisive = [name for name, each in properties.items() if each["scope"] != "window"]
    assert trust["supported"] == "limited"
    assert trust["restrictedConfigurations"] == decisive == ["deros.path", "deros.interfaces"]


def test_lock_pins_every_package_and_names_no_registry() -> None:
    """Any mirror will do, and what it gives is held against a digest."""
    lock: Any = json.loads((SOURCE / "package-lock.json").read_text(encoding="utf-8"))
    packages = {name: each for name, each in lock["packages"].items() if name}
    assert len(packages) > 100
    assert all(re.match("sha512-", each["integrity"]) for each in packages.values())
    assert not any("resolved" in each for each in packages.values())
    wanted = lock["packages"][""]
    assert all(wanted[key] == PACKAGE[key] for key in ("dependencies", "devDependencies"))


@may_run("npm")
def test_without_npm_it_says_so(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    """``make vscode`` fails, says what to install, and leaves nothing."""
    monkeypatch.setenv("PATH", str(tmp_path))
    assert vscode.main(["--output", str(tmp_path / "dist")]) == 1
    assert "no extension for VS Code: there is no npm; install" in capsys.readouterr().err
    assert not (tmp_path / "dist").exists()
