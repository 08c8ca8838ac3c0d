"""``deros generate``: its own options, the generator's, what it says and what it leaves alone."""

from __future__ import annotations

from pathlib import Path

import pytest

from tests.support.cli import deros


@pytest.fixture(autouse=True)
def _models(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    assert deros("new", "system", "courier").code == 0


def _tree(directory: Path) -> dict[str, bytes]:
    return {
        str(p.relative_to(directory)): p.read_bytes() for p in directory.rglob("*") if p.is_file()
    }


def test_files_are_written_once_and_reported() -> None:
    """The first run names what it wrote; the second finds nothing to do."""
    first = deros("generate", "courier.system", "--target", "params", "-o", "out")
    assert first.code == 0
    assert first.out.startswith("wrote out/")
    before = _tree(Path("out"))
    second = deros("generate", "courier.system", "--target", "params", "-o", "out")
    assert second.code == 0
    assert "unchanged" in second.out
    assert _tree(Path("out")) == before


def test_hand_edits_are_kept_unless_overwrite() -> None:
    """A generated file that was edited is reported and kept; ``--overwrite`` replaces it."""
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


def test_options_of_the_generator() -> None:
    """``--name value`` and ``--name=value`` reach the generator; others are named as unknown."""
    for given in (["--maintainer", "Jo <jo@example.com>"], ["--maintainer=Jo <jo@example.com>"]):
        outcome = deros("generate", "courier_base.rnd", "--target", "python", "-o", "out", *given)
        assert outcome.code == 0, outcome.err
    (package,) = Path("out").rglob("package.xml")
    assert 'email="jo@example.com"' in package.read_text()
    unknown = deros("generate", "courier_base.rnd", "--target", "python", "--maintaner", "x")
    assert unknown.code == 2
    assert "did you mean '--maintainer'" in unknown.err


@pytest.mark.parametrize("extra", [["--maintainer"], ["-x"]])
def test_unfinished_options_are_usage_errors(extra: list[str]) -> None:
    """An option without its value, or of one letter, is a mistake on the command line."""
    outcome = deros("generate", "courier_base.rnd", "--target", "python", *extra)
    assert outcome.code == 2
    assert "Usage:" in outcome.err


def test_unknown_targets_name_the_ones_there_are() -> None:
    """A misspelt target is answered by DRS404 with the nearest, and exit code 2."""
    outcome = deros("generate", "courier.system", "--target", "lanch", "-o", "out")
    assert outcome.code == 2
    assert "DRS404" in outcome.err
    assert "did you mean 'launch'?" in outcome.err
    assert not Path("out").exists()


def test_help_lists_targets_and_their_options() -> None:
    """The generators of the environment appear below the help, with what they take."""
    text = deros("generate", "--help").out
    for expected in ("rosnode -> python", "rossystem -> launch", "deros -> python", "--maintainer"):
        assert expected in text


def test_missing_model_exits_with_2() -> None:
    """A model that cannot be read is no model with errors."""
    assert deros("generate", "nowhere.system", "--target", "launch").code == 2


def test_a_place_that_cannot_be_written_stays_as_it_was() -> None:
    """When one file cannot be put in place, all others stay as they were."""
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


def test_a_node_of_the_same_package_is_checked_too(tmp_path: Path) -> None:
    """Its code is generated with that of the model, so its errors count, of whatever kind."""
    (tmp_path / "talker.rnd").write_text("node talker : chat")
    (tmp_path / "listener.rnd").write_text("node listener : chat publishes topic a : no_msgs.No")
    outcome = deros(
        "generate", tmp_path / "talker.rnd", "--target", "python", "-o", tmp_path / "out"
    )
    assert outcome.code == 1
    assert "DRS101" in outcome.err
    assert not (tmp_path / "out").exists()
