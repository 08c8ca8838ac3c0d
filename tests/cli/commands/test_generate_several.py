"""``deros generate`` for several files and folders: all outputs are written, or none."""

from __future__ import annotations

from pathlib import Path

import pytest

from tests.support.cli import deros

pytestmark = pytest.mark.usefixtures("own_folder")


def _node(path: str, name: str, package: str, port: str = "out", more: str = "") -> None:
    Path(path).parent.mkdir(parents=True, exist_ok=True)
    Path(path).write_text(
        f"node {name} : {package}\n{more}publishes\n  topic {port} : std_msgs.Bool\n"
    )


def _packages(folder: str) -> list[str]:
    return sorted(path.parent.name for path in Path(folder).rglob("package.xml"))


def test_several_files_in_one_run() -> None:
    """Each is generated; options reach the generators that have them."""
    _node("a.rnd", "a", "pkg_a")
    _node("b.rnd", "b", "pkg_b")
    outcome = deros(
        "generate", "a.rnd", "b.rnd", "--target", "python", "-o", "ws", "--copyright", "2026 X"
    )
    assert outcome.code == 0, outcome
    assert _packages("ws") == ["pkg_a", "pkg_b"]
    assert "2026 X" in Path("ws/pkg_b/setup.py").read_text()


def test_options_may_be_anywhere() -> None:
    """A generator option takes the next word, wherever the files are."""
    _node("a.rnd", "a", "pkg_a")
    outcome = deros(
        "generate", "--copyright", "2026 X", "a.rnd", "--maintainer=Y <y@z>", "--target", "cpp"
    )
    assert outcome.code == 0, outcome
    assert 'email="y@z"' in Path("pkg_a/package.xml").read_text()


def test_folder_generates_all_models_with_the_target() -> None:
    """Nodes of one package are generated together; other languages are skipped."""
    _node("m/a.rnd", "a", "pkg")
    _node("m/b.rnd", "b", "pkg")
    _node("m/sub/c.rnd", "c", "pkg_c")
    _node("m/old.rnd", "old", "pkg_old", more='executable "old"\n')
    _node("m/build/d.rnd", "d", "pkg_d")
    _node("m/.hidden/e.rnd", "e", "pkg_e")
    Path("m/s.system").write_text("system S\n")
    outcome = deros("generate", "m", "--target", "python", "-o", "ws")
    assert outcome.code == 0, outcome
    assert _packages("ws") == ["pkg", "pkg_c"]
    assert Path("ws/pkg/pkg/a.py").exists()
    assert Path("ws/pkg/pkg/b.py").exists()
    again = deros("generate", "m", "--target", "python", "-o", "ws")
    assert "wrote" not in again.out


def test_new_project_can_be_generated_at_once() -> None:
    """Robot node, safety node and launch file are generated; the safety node has no stubs."""
    assert deros("new", "rules", "courier").code == 0
    Path("deros.toml").write_text(
        'output = "ws"\n[targets]\nrnd = "python"\nderos = "python"\n'
        'system = ["launch", "params"]\n'
    )
    outcome = deros("generate", ".")
    assert outcome.code == 0, outcome
    assert _packages("ws") == ["courier", "courier_safety", "deros_runtime"]
    assert Path("ws/courier_system.launch.py").exists()
    assert Path("ws/courier_safety/courier_safety/monitor.py").exists()
    models = [path for path in Path().iterdir() if path.suffix in (".rnd", ".system", ".deros")]
    checked = deros("check", ".").out  # none is generated
    assert checked.startswith(f"{len(models)} files checked")
    before = {path: path.stat().st_mtime_ns for path in Path("ws").rglob("*")}
    assert deros("generate", ".").code == 0
    assert {path: path.stat().st_mtime_ns for path in Path("ws").rglob("*")} == before


def test_part_of_another_system_is_not_generated_from_a_folder() -> None:
    """Parts are checked and launched only if they are given explicitly."""
    _node("m/a.rnd", "a", "pkg")
    Path("m/part.system").write_text(
        'system Part\nimports import "a.rnd"\ntopics topic /x\n'
        "node a : a wirings connect out to /x\n"
    )
    Path("m/whole.system").write_text(
        'system Whole\nimports import "part.system"\ntopics external topic /x\n'
        "subsystem part : Part\n"
    )
    assert "DRS211" not in deros("check", "m").out
    assert "DRS211" in deros("check", "m/part.system").out
    assert deros("generate", "m", "--target", "launch", "-o", "ws").code == 0
    assert [path.name for path in Path("ws").glob("*.launch.py")] == ["whole.launch.py"]


def test_error_in_one_file_writes_nothing() -> None:
    """All files of a run are written, or none."""
    _node("a.rnd", "a", "pkg_a")
    Path("b.rnd").write_text("node b : pkg_b\nparameters name x : int = 0.5\n")
    outcome = deros("generate", "a.rnd", "b.rnd", "--target", "python", "-o", "ws")
    assert outcome.code == 1
    assert not Path("ws").exists()


def test_colliding_outputs_are_rejected() -> None:
    """Two folders that each describe part of one package would overwrite each other."""
    _node("one/a.rnd", "a", "pkg")
    _node("two/b.rnd", "b", "pkg")
    outcome = deros("generate", "one", "two", "--target", "python", "-o", "ws")
    assert outcome.code == 2
    assert "one/a.rnd and two/b.rnd" in outcome.err
    assert not Path("ws").exists()


def test_missing_target_is_a_usage_error() -> None:
    """A file needs a target, a folder a model with the target, and a depfile a single model."""
    _node("m/a.rnd", "a", "pkg_a")
    _node("m/b.rnd", "b", "pkg_b")
    Path("empty").mkdir()
    for arguments in (
        ("m/a.rnd",),
        ("m",),
        ("m", "--target", "launch"),
        ("empty", "--target", "python"),
        ("--target", "python"),
        ("m", "--target", "python", "--depfile", "d"),
        ("m", "--target", "python", "--scaffold", "s"),
        ("m", "--target", "python", "--nope", "x"),
        ("m", "--target", "python", "-x"),
    ):
        outcome = deros("generate", *arguments)
        assert outcome.code == 2, arguments
        assert "Traceback" not in outcome.err
    assert deros("generate", "m/a.rnd", "--target", "lanch").code == 2
    assert deros("check", "empty").code == 2


def test_models_below_a_folder_are_checked_once() -> None:
    """It does not matter how a model is reached."""
    _node("m/a.rnd", "a", "pkg_a")
    Path("m/sub").mkdir()
    Path("m/sub/b.rnd").write_text("node b : pkg_b\nparameters name x : int = 0.5\n")
    outcome = deros("check", "m", "m/a.rnd", "m/sub")
    assert outcome.code == 1
    assert outcome.out.count("DRS103") == 1
    assert outcome.out.endswith("1 error in 2 files\n")
