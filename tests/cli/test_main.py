"""The command group: its overview, its exit codes, and internal errors."""

from __future__ import annotations

import os
import subprocess
import sys
from pathlib import Path

import click
import pytest

from deros import __version__
from deros.cli import main
from deros.cli.options import FiniteRange
from tests.support.cli import deros
from tests.support.needs import needs

DEROS = str(Path(sys.executable).with_name("deros"))


def test_overview_lists_every_command() -> None:
    """``deros --help`` lists the commands with the first line of their help."""
    outcome = deros("--help")
    assert outcome.code == 0
    for name, (_, summary) in main.COMMANDS.items():
        assert name in outcome.out
        assert summary in outcome.out


@pytest.mark.parametrize("name", main.COMMANDS)
def test_every_command_has_help(name: str) -> None:
    """Each command can be imported from its table entry and prints its help."""
    outcome = deros(name, "--help")
    assert outcome.code == 0
    assert outcome.out.startswith(f"Usage: deros {name}")


@pytest.mark.parametrize("name", main.COMMANDS)
def test_every_number_has_to_be_finite(name: str) -> None:
    """``nan`` is within all bounds of click, and a time of ``nan`` seconds never ends."""
    command = main.deros.get_command(click.Context(main.deros), name)
    assert command is not None
    for each in command.params:
        assert each.type is not click.FLOAT, each.name
        if isinstance(each.type, click.FloatRange):
            assert isinstance(each.type, FiniteRange), each.name
            for text in ("nan", "-nan", "inf", "-inf", "1e999"):
                with pytest.raises(click.BadParameter):
                    each.type.convert(text, each, None)


def test_help_is_fast() -> None:
    """The overview takes little more processor time than starting the interpreter."""

    def seconds(command: list[str]) -> float:
        before = os.times()
        subprocess.run(command, check=True, capture_output=True)
        after = os.times()
        used = after.children_user - before.children_user
        return used + after.children_system - before.children_system

    start = min(seconds([sys.executable, "-c", ""]) for _ in range(3))
    # click alone takes a fifth of the bound; one library too many takes all of it.
    assert min(seconds([DEROS, "--help"]) for _ in range(3)) - start < 0.2


def test_version_is_that_of_the_package() -> None:
    """``--version`` prints the version of the package."""
    assert deros("--version").out == f"deros, version {__version__}\n"


def test_unknown_command_gets_a_suggestion() -> None:
    """The usage error names the similar command."""
    outcome = deros("chekc", "x.rnd")
    assert outcome.code == 2
    assert "did you mean 'check'?" in outcome.err


@pytest.mark.parametrize("arguments", [[], ["check"], ["generate"], ["new"], ["check", "--nope"]])
def test_usage_errors_exit_with_2(arguments: list[str]) -> None:
    """The error is explained on standard error, without a traceback."""
    outcome = deros(*arguments)
    assert outcome.code == 2
    assert "Usage: deros" in outcome.err
    assert outcome.out == ""


def test_invalid_argument_of_the_script_exits_with_2(tmp_path: Path) -> None:
    """Arguments that a command forwards to another parser fail in the same way."""
    (tmp_path / "empty.system").write_text("system Empty\n")
    assert deros("up", tmp_path / "empty.system", "--", "--nope").code == 2


def test_internal_error_is_reported_as_a_bug(monkeypatch: pytest.MonkeyPatch) -> None:
    """An unexpected exception gives one line and exit code 2; ``--debug`` adds the traceback."""

    def broken(*_: object, **__: object) -> None:
        raise LookupError("no such thing")

    monkeypatch.setattr("deros.cli.commands.check.find", broken)
    outcome = deros("check", "x.rnd")
    assert outcome.code == 2
    assert "bug in deros" in outcome.err
    assert "LookupError: no such thing" in outcome.err
    assert "Traceback" not in outcome.err
    assert "Traceback" in deros("--debug", "check", "x.rnd").err


def test_interrupt_gives_no_traceback(monkeypatch: pytest.MonkeyPatch) -> None:
    """An interrupted run exits with 130."""

    def interrupted(*_: object, **__: object) -> None:
        raise KeyboardInterrupt

    monkeypatch.setattr("deros.cli.commands.check.find", interrupted)
    outcome = deros("check", "x.rnd")
    assert outcome.code == 130
    assert "Traceback" not in outcome.err


@needs("bash")
def test_closed_pipe_gives_no_traceback(tmp_path: Path) -> None:
    """If the reader of the output exits early, the command exits silently."""
    bad = tmp_path / "bad.rnd"
    bad.write_text(
        "node a : demo\nparameters\n" + "".join(f"  name p{i} : int = 1.5\n" for i in range(3000))
    )
    command = f"{DEROS} check {bad} | head -n 1; exit ${{PIPESTATUS[0]}}"
    done = subprocess.run(["bash", "-c", command], capture_output=True, text=True, check=False)
    assert done.returncode == 141
    assert done.stdout.count("\n") == 1
    assert done.stderr == ""
