"""Depfiles and stamps for build systems: complete inputs, and reliable stamps."""

from __future__ import annotations

import os
import subprocess
from pathlib import Path

import pytest

import deros.generators
from deros.pipeline.depfile import depfile, is_current, prerequisites, read_stamp
from tests.support.builds import PROGRAM, frozen_program, models, replace, touch
from tests.support.cli import Outcome
from tests.support.cli import deros as run
from tests.support.needs import needs

pytestmark = pytest.mark.usefixtures("own_folder")

AWKWARD = ["/a b/c.rnd", "/costs $5/x", "/one#two", "/tab\there", "/plain"]


def _generate(model: str, target: str, *more: str) -> Outcome:
    outcome = run(
        *("generate", model, "--target", target, "-o", "out"),
        *("--depfile", "depends.d", "--stamp", "stamp", *more),
    )
    assert outcome.code == 0, outcome.err
    return outcome


def _inputs() -> set[str]:
    """Return the inputs, relative to the current folder if they are below it."""
    inputs = prerequisites(Path("depends.d").read_text())
    return {
        os.path.relpath(each) if Path(each).is_relative_to(Path.cwd()) else each for each in inputs
    }


def test_special_characters_round_trip() -> None:
    """Spaces, dollars and hashes are escaped for Make, and read back unchanged."""
    assert prerequisites(depfile(["/the stamp"], AWKWARD)) == AWKWARD


@needs("make", "touch")
def test_make_reads_special_file_names(tmp_path: Path) -> None:
    """Make rebuilds exactly when a file with a special name changes."""
    sources = [tmp_path / name for name in ("a b.rnd", "costs $5", "one#two")]
    for source in sources:
        source.write_text("")
        os.utime(source, ns=(1, 1))
    (tmp_path / "rule.d").write_text(depfile(["the stamp"], map(str, sources)))
    (tmp_path / "Makefile").write_text("include rule.d\nthe\\ stamp:\n\t@echo again; touch '$@'\n")

    def made() -> str:
        command = ["make", "--no-print-directory", "the stamp"]
        return subprocess.run(command, capture_output=True, text=True, check=True).stdout

    assert made() == "again\n"
    assert "again" not in made()
    for source in sources:
        later = Path("the stamp").stat().st_mtime_ns + 1_000_000
        os.utime(source, ns=(later, later))
        os.utime("rule.d", ns=(1, 1))
        assert made() == "again\n"
        os.utime("the stamp", ns=(later, later))


MAKEFILE = """
build/robot.stamp: robot.deros
\t{deros} generate robot.deros --target c -o build --depfile build/robot.d --stamp $@

build/robot_monitor.c: build/robot.stamp ;

-include build/robot.d
"""


@needs("make")
def test_makefile_with_a_depfile_rebuilds_only_changes(tmp_path: Path) -> None:
    """Make generates exactly when an imported model changes."""
    models(tmp_path)
    (tmp_path / "Makefile").write_text(MAKEFILE.format(deros=frozen_program()))

    def made() -> str:
        command = ["make", "build/robot_monitor.c"]
        return subprocess.run(command, capture_output=True, text=True, check=True).stdout

    assert "wrote build/robot_monitor.c" in made()
    assert "up to date" in made()
    touch(tmp_path / "robot_robot.rnd")
    assert "3 files unchanged" in made()
    assert "up to date" in made()


@pytest.mark.slow
def test_parallel_runs_do_not_interfere(tmp_path: Path) -> None:
    """Builds that generate into one folder at the same time leave it complete."""
    models(tmp_path)
    command = [str(PROGRAM), "generate", "robot.deros", "--target", "python", "-o", "out"]
    command += ["--depfile", "depends.d", "--stamp", "stamp"]
    runs = [subprocess.Popen(command, stdout=subprocess.DEVNULL) for _ in range(3)]
    assert [each.wait(timeout=60) for each in runs] == [0, 0, 0]
    run("generate", "robot.deros", "--target", "python", "-o", "alone")
    Path("alone/.deros-origins.json").unlink()  # the folder of a build system needs no such record
    alone = {p.relative_to("alone"): p.read_text() for p in Path("alone").rglob("*.*")}
    assert {p.relative_to("out"): p.read_text() for p in Path("out").rglob("*.*")} == alone


def test_depfile_lists_everything_that_was_read(tmp_path: Path) -> None:
    """Models with their imports, definitions given as files, and deros itself are inputs."""
    models(tmp_path)
    definitions = tmp_path / "msgs/nav_msgs/msg"
    definitions.mkdir(parents=True)
    text = "geometry_msgs/TwistWithCovariance twist\n"
    (definitions / "Odometry.msg").write_text(text)
    _generate("robot.deros", "c", "--interfaces", "msgs")
    inputs = _inputs()
    assert inputs >= {"robot.deros", "robot.system", "robot_robot.rnd"}
    assert inputs >= {"msgs", "msgs/nav_msgs", "msgs/nav_msgs/msg/Odometry.msg"}
    assert str(Path(deros.generators.__file__)) in inputs
    assert any(each.endswith(".dist-info/METADATA") for each in inputs)
    assert all(Path(each).exists() for each in inputs)


def test_folders_of_import_globs_are_inputs(tmp_path: Path) -> None:
    """The folder is an input if a new file or folder in it may match a glob."""
    models(tmp_path)
    for name in ("nodes/left", "nodes/right"):
        (tmp_path / name).mkdir(parents=True)
    (tmp_path / "robot_robot.rnd").rename(tmp_path / "nodes/left/robot_robot.rnd")
    replace(tmp_path / "robot.system", '"robot_robot.rnd"', '"nodes/*/robot_*.rnd"')
    _generate("robot.system", "script")
    assert _inputs() >= {"nodes", "nodes/left", "nodes/right", "nodes/left/robot_robot.rnd"}
    replace(tmp_path / "robot.system", "nodes/*/", "nodes/**/")
    _generate("robot.system", "script")
    assert _inputs() >= {"nodes", "nodes/left", "nodes/right"}
    replace(tmp_path / "robot.system", "nodes/**/robot_*", "nodes/left/robot_robot")
    _generate("robot.system", "script")
    assert {each for each in _inputs() if Path(each).is_dir()} == set()


def test_folder_of_a_package_is_an_input(tmp_path: Path) -> None:
    """Nodes of one package are generated together, so a new description needs a new run."""
    (tmp_path / "a.rnd").write_text("node a : both\npublishes\n  topic x : std_msgs.Bool\n")
    _generate("a.rnd", "python")
    assert "." in _inputs()


def test_stamp_lists_the_output(tmp_path: Path) -> None:
    """It lists the files that deros maintains, without user files."""
    models(tmp_path)
    _generate("robot.deros", "python")
    listed = read_stamp(Path("stamp"))
    files = {str(p.relative_to("out")) for p in Path("out").rglob("*") if p.is_file()}
    assert files - set(listed) == {
        "robot_safety/package.xml",
        "robot_safety/robot_safety/robot_safety_node_actions.py",
    }
    assert listed == sorted(listed)


def test_depfile_without_a_stamp_targets_the_output(tmp_path: Path) -> None:
    """The rule may be about the generated files themselves."""
    models(tmp_path)
    run("generate", "robot.deros", "--target", "c", "-o", "out", "--depfile", "d")
    head = Path("d").read_text().partition(": \\\n")[0]
    assert head == "out/robot_contracts.h out/robot_monitor.c out/robot_monitor.h"


def test_files_no_longer_generated_are_removed(tmp_path: Path) -> None:
    """The files of a removed node are deleted, unless they were edited."""
    for name in "ab":
        text = f"node {name} : both\nparameters\n  name x : int = 1\n"
        (tmp_path / f"{name}.rnd").write_text(text)
    _generate("a.rnd", "python")
    package = tmp_path / "out/both"
    edited = package / "config/b.yaml"
    edited.write_text(edited.read_text() + "# mine\n")
    (tmp_path / "b.rnd").unlink()
    _generate("a.rnd", "python")
    assert edited.exists()
    assert not (package / "launch/b.launch.py").exists()
    assert not (package / "both/b_base.py").exists()
    assert (package / "both/b.py").exists(), "a user file, written only once"
    assert (package / "launch/a.launch.py").exists()


def test_model_error_leaves_everything_unchanged(tmp_path: Path) -> None:
    """Output, stamp and depfile are not touched."""
    rules = models(tmp_path)
    _generate("robot.deros", "c")
    before = {p: (p.read_bytes(), p.stat().st_mtime_ns) for p in tmp_path.rglob("*") if p.is_file()}
    before.pop(rules)
    replace(rules, "0.5 m/s", "0.5 kg")
    outcome = run(
        *("generate", "robot.deros", "--target", "c", "-o", "out"),
        *("--depfile", "depends.d", "--stamp", "stamp"),
    )
    assert outcome.code == 1
    assert "robot.deros:13:27: error[DRS306 incompatible-units]" in outcome.err
    assert {p: (p.read_bytes(), p.stat().st_mtime_ns) for p in before} == before


def test_stamp_has_the_start_time_of_its_run(tmp_path: Path) -> None:
    """A model saved after the start of the run is newer than the stamp."""
    rules = models(tmp_path)
    _generate("robot.deros", "c")
    stamp, rule = Path("stamp"), Path("depends.d")
    assert stamp.stat().st_mtime_ns <= Path("out/robot_monitor.c").stat().st_mtime_ns
    assert is_current(stamp, rule)
    later = stamp.stat().st_mtime_ns + 1_000_000
    os.utime(rules, ns=(later, later))
    assert not is_current(stamp, rule)
    rules.unlink()
    assert not is_current(stamp, rule)
    assert not is_current(tmp_path / "none", rule)
    assert not is_current(stamp, tmp_path / "none")


def test_other_file_is_not_overwritten_as_a_stamp(tmp_path: Path) -> None:
    """A model given as the stamp by mistake is kept."""
    rules = models(tmp_path)
    before = rules.read_bytes()
    command = ["generate", "robot.deros", "--target", "c", "-o", "out"]
    outcome = run(*command, "--stamp", "robot.deros")
    assert outcome.code == 2
    assert "robot.deros: it is not a stamp of deros" in outcome.err
    assert rules.read_bytes() == before
    outcome = run(*command, "--stamp", "s", "--scaffold", "x")
    assert outcome.code == 2
    assert "--scaffold cannot be combined with" in outcome.err


def test_unwritable_stamp_is_an_error(tmp_path: Path) -> None:
    """A folder in place of the stamp is reported, with exit code 2."""
    models(tmp_path)
    outcome = run(
        *("generate", "robot.deros", "--target", "c", "-o", "out", "--depfile", "out/x/y"),
        *("--stamp", "robot.deros/stamp"),
    )
    assert outcome.code == 2
    assert "cannot write robot.deros/stamp" in outcome.err
