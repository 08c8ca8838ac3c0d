"""``deros generate``: options, generator options, messages and files left alone."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import pytest

from deros.generators.api.protocol import Context, Files, OptionError, Options
from deros.generators.api.registry import Generator, Registry
from tests.support.cli import deros


@pytest.fixture(autouse=True)
def _models(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    assert deros("new", "system", "courier").code == 0


def _tree(directory: Path) -> dict[str, bytes]:
    return {
        str(p.relative_to(directory)): p.read_bytes() for p in directory.rglob("*") if p.is_file()
    }


def test_unchanged_files_are_not_written_again() -> None:
    """The first run lists the files it wrote; the second has nothing to do."""
    first = deros("generate", "courier.system", "--target", "params", "-o", "out")
    assert first.code == 0
    assert first.out.startswith("wrote out/")
    before = _tree(Path("out"))
    second = deros("generate", "courier.system", "--target", "params", "-o", "out")
    assert second.code == 0
    assert "unchanged" in second.out
    assert _tree(Path("out")) == before


def test_edited_files_are_kept_without_overwrite() -> None:
    """An edited generated file is reported and kept; ``--overwrite`` replaces it."""
    deros("generate", "courier.system", "--target", "launch", "-o", "out")
    (file,) = Path("out").rglob("*.launch.py")
    generated = file.read_text()
    file.write_text(generated + "# mine\n")
    kept = deros("generate", "courier.system", "--target", "launch", "-o", "out")
    assert kept.code == 0
    assert "DRS403" in kept.err
    assert file.read_text().endswith("# mine\n")
    deros("generate", "courier.system", "--target", "launch", "-o", "out", "--overwrite")
    assert file.read_text() == generated


def test_options_reach_the_generator() -> None:
    """``--name value`` and ``--name=value`` reach the generator; unknown options are reported."""
    for given in (["--maintainer", "Jo <jo@example.com>"], ["--maintainer=Jo <jo@example.com>"]):
        outcome = deros("generate", "courier_base.rnd", "--target", "python", "-o", "out", *given)
        assert outcome.code == 0, outcome.err
    (package,) = Path("out").rglob("package.xml")
    assert 'email="jo@example.com"' in package.read_text()
    unknown = deros("generate", "courier_base.rnd", "--target", "python", "--maintaner", "x")
    assert unknown.code == 2
    assert "did you mean '--maintainer'" in unknown.err


@pytest.mark.parametrize("extra", [["--maintainer"], ["-x"]])
def test_incomplete_options_are_usage_errors(extra: list[str]) -> None:
    """An option without its value, or with one letter, is a usage error."""
    outcome = deros("generate", "courier_base.rnd", "--target", "python", *extra)
    assert outcome.code == 2
    assert "Usage:" in outcome.err


@pytest.mark.parametrize(
    ("raised", "told"),
    [(OptionError("colour 'x' is not one"), "Usage:"), (ValueError("x"), "deros: this is a bug")],
)
def test_only_a_fault_of_an_option_is_told_as_one(
    monkeypatch: pytest.MonkeyPatch, raised: ValueError, told: str
) -> None:
    """A generator's own fault is not shown as if the command line were wrong."""

    def faulty(model: Any, context: Context, options: Options) -> Files:
        del model, context, options
        raise raised

    monkeypatch.setattr(Registry, "find", lambda *_: Generator("rosnode", "python", faulty, ()))
    outcome = deros("generate", "courier_base.rnd", "--target", "python")
    assert outcome.code != 0
    assert outcome.err.startswith(told)
    assert str(raised) in outcome.err


def test_unknown_target_gets_a_suggestion() -> None:
    """A misspelt target gives DRS404 with the nearest one, and exit code 2."""
    outcome = deros("generate", "courier.system", "--target", "lanch", "-o", "out")
    assert outcome.code == 2
    assert "DRS404" in outcome.err
    assert "did you mean 'launch'" in outcome.err
    assert not Path("out").exists()


def test_help_lists_targets_and_their_options() -> None:
    """The installed generators are listed below the help, with their options."""
    text = deros("generate", "--help").out
    for expected in ("rosnode -> python", "rossystem -> launch", "deros -> python", "--maintainer"):
        assert expected in text


def test_missing_model_exits_with_2() -> None:
    """An unreadable model is not a model with errors."""
    assert deros("generate", "nowhere.system", "--target", "launch").code == 2


def test_failed_write_leaves_the_output_unchanged() -> None:
    """If one file cannot be replaced, all others stay as they were."""
    deros("generate", "courier_base.rnd", "--target", "python", "-o", "out")
    before = _tree(Path("out"))
    generated = next(p for p in Path("out").rglob("package.xml"))
    generated.unlink()
    generated.mkdir()
    text = Path("courier_base.rnd").read_text()
    Path("courier_base.rnd").write_text(text.replace("topic odom", "topic odometry"))
    outcome = deros("generate", "courier_base.rnd", "--target", "python", "-o", "out")
    assert outcome.code == 2
    assert "cannot write" in outcome.err
    generated.rmdir()
    after = _tree(Path("out"))
    assert after == {path: content for path, content in before.items() if path in after}
    assert set(before) - set(after) == {str(generated.relative_to("out"))}


def test_nothing_is_written_where_the_review_fails(monkeypatch: pytest.MonkeyPatch) -> None:
    """Files that cannot even be read again, by a bug in a generator, replace no good ones."""

    def fail(*_: object) -> None:
        raise SyntaxError("unterminated string literal")

    monkeypatch.setattr("deros.generators.user_files.review.review", fail)
    outcome = deros("generate", "courier_base.rnd", "--target", "python", "-o", "out")
    assert "this is a bug in deros" in outcome.err
    assert not Path("out").exists()


def test_other_nodes_of_the_package_are_checked(tmp_path: Path) -> None:
    """Their code is generated too, so all their errors count."""
    (tmp_path / "talker.rnd").write_text("node talker : chat")
    (tmp_path / "listener.rnd").write_text("node listener : chat publishes topic a : no_msgs.No")
    outcome = deros(
        "generate", tmp_path / "talker.rnd", "--target", "python", "-o", tmp_path / "out"
    )
    assert outcome.code == 1
    assert "DRS101" in outcome.err
    assert not (tmp_path / "out").exists()
