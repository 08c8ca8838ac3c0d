"""``deros explain``: the page of a code, by number or slug."""

from __future__ import annotations

import io
import os
import re
import subprocess
import sys
from pathlib import Path

import pytest

from deros import codes
from deros.cli.commands import explain
from deros.codes import ALL_CODES, SLUGS
from deros.diagnostics import Code
from tests.support.cli import deros
from tests.support.needs import needs

DEROS = Path(sys.executable).with_name("deros")


@pytest.mark.parametrize(
    "word", ["DRS317", "drs317", "317", "DRS-317", "input-without-timeout", "INPUT_WITHOUT_TIMEOUT"]
)
def test_code_is_found_by_number_or_slug(word: str) -> None:
    """Numbers, codes in any case and slugs are accepted."""
    assert deros("explain", word).out.startswith("# DRS317: ")


def test_every_code_has_one_slug() -> None:
    """A slug is the name of the constant in words, of which there are at least two."""
    assert set(SLUGS.values()) == set(ALL_CODES.values())
    assert len(SLUGS) == len(ALL_CODES)
    constants = {name: each for name, each in vars(codes).items() if isinstance(each, Code)}
    for name, code in constants.items():
        assert code.slug == name.lower().replace("_", "-")
        assert SLUGS[code.slug] is code
        assert re.fullmatch(r"[a-z]+(-[a-z0-9]+)+", code.slug)


@pytest.mark.parametrize(
    ("word", "hint"),
    [
        ("DRS999", "did you mean 'DRS"),
        ("input-without-timeot", "did you mean 'input-without-timeout'"),
        ("xyzzy", "'deros explain' lists all diagnostics"),
        ("", "'deros explain' lists all diagnostics"),
    ],
)
def test_unknown_code_gets_suggestions(word: str, hint: str) -> None:
    """The exit code is that of a usage error."""
    outcome = deros("explain", word)
    assert (outcome.code, outcome.out) == (2, "")
    assert hint in outcome.err


def test_several_codes_are_explained_and_no_code_lists_all() -> None:
    """The pages follow each other; without a code, all are listed."""
    both = deros("explain", "DRS317", "DRS210").out
    assert both.index("# DRS317") < both.index("# DRS210")
    listing = deros("explain").out.splitlines()
    assert len(listing) == len(ALL_CODES)
    assert any(line.split()[:2] == ["DRS317", "input-without-timeout"] for line in listing)


class _Terminal(io.StringIO):
    def isatty(self) -> bool:
        return True


@pytest.mark.parametrize("colour", [True, False])
def test_terminal_gets_formatted_pages(monkeypatch: pytest.MonkeyPatch, colour: bool) -> None:
    """Headings and links are not shown as Markdown; NO_COLOR is respected."""
    terminal = _Terminal()
    monkeypatch.setattr(sys, "stdout", terminal)
    monkeypatch.setenv("TERM", "xterm-256color")
    monkeypatch.delenv("NO_COLOR", raising=False)
    if not colour:
        monkeypatch.setenv("NO_COLOR", "1")
    explain.show("# Title\n\nSee [this](that.md#there) `code`.\n\n```rossystem\n[a](b)\n```\n")
    text = terminal.getvalue()
    assert "that.md" not in text
    assert "[a](b)" in text
    assert "# Title" not in text
    assert (";36" in text) is colour


@pytest.mark.parametrize("shell", [pytest.param("bash", marks=needs("bash")), "zsh", "fish"])
def test_each_shell_has_a_completion_script(shell: str) -> None:
    """The documented command prints a script and succeeds."""
    environment = {**os.environ, "_DEROS_COMPLETE": f"{shell}_source"}
    done = subprocess.run([DEROS], env=environment, capture_output=True, text=True, check=False)
    assert (done.returncode, done.stderr) == (0, "")
    assert "_DEROS_COMPLETE" in done.stdout
    documentation = Path(__file__).resolve().parents[3] / "docs" / "command-line.md"
    assert f"_DEROS_COMPLETE={shell}_source deros" in documentation.read_text(encoding="utf-8")


@pytest.mark.parametrize(
    ("words", "expected"),
    [
        ("deros ch", "plain,check"),
        ("deros check --bas", "plain,--baseline"),
        ("deros explain input-w", "plain,input-without-timeout"),
        ("deros explain DRS31", "plain,DRS317"),
    ],
)
def test_completion_of_commands_options_and_codes(words: str, expected: str) -> None:
    """The request of bash is answered, with exit code 0."""
    environment = {
        **os.environ,
        "_DEROS_COMPLETE": "bash_complete",
        "COMP_WORDS": words,
        "COMP_CWORD": str(len(words.split()) - 1),
    }
    done = subprocess.run([DEROS], env=environment, capture_output=True, text=True, check=False)
    assert done.returncode == 0
    assert expected in done.stdout.splitlines()
