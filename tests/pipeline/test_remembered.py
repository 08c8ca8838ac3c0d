"""Findings of unchanged models are recalled; whatever they rest on, its change is seen."""

from __future__ import annotations

import os
import shutil
import sys
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest

from deros.cli.commands import check as command
from deros.cli.commands.check import find
from deros.generators.api.protocol import Context, Files, Options
from deros.generators.api.registry import Generator, Registry
from deros.interfaces.files import recorded
from deros.pipeline import remembered
from deros.pipeline.remembered import Found, Memory
from deros.report import formats
from tests.support.cli import deros

CASES = Path(__file__).parents[1] / "cases"

NODE = """\
node camera : camera_driver
parameters
  name calibration : string = "calibration/left.yaml"
  name rate : double = 10.0
publishes
  topic image : sensor_msgs.Image
  topic state : robot_msgs.State
"""
SYSTEM = """\
system Robot
imports
  import "nodes/*.rnd"
topics
  topic /image  // deros: allow no-subscriber the operator looks at it
parameters from "camera.yaml"
parameters from "share:robot_bringup/robot.yaml"
launch "tools.launch.xml" (level = 1) provides { }
node camera : camera
  parameters
    param calibration = "calibration/left.yaml"
  wirings
    connect image to /image
    connect state to /state
"""


@pytest.fixture(autouse=True)
def cache(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """Keep findings in a folder of the test, and know one prefix with packages."""
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path / "cache"))
    monkeypatch.setenv("AMENT_PREFIX_PATH", str(tmp_path / "prefix"))
    return tmp_path / "cache/deros/check"


@pytest.fixture
def project(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """Return the current folder, with a system that asks the file system all that there is."""
    folder = tmp_path / "work/robot"
    (folder / "nodes").mkdir(parents=True)
    (folder / "calibration").mkdir()
    (folder / "nodes/camera.rnd").write_text(NODE)
    (folder / "robot.system").write_text(SYSTEM)
    monkeypatch.chdir(folder)
    return folder


def _checks(monkeypatch: pytest.MonkeyPatch) -> list[object]:
    """Return the checks that are made from now on."""
    made: list[object] = []
    genuine = command._checked

    def counted(files: list[str], interfaces: list[Path]) -> Found:
        made.append(files)
        return genuine(files, interfaces)

    monkeypatch.setattr(command, "_checked", counted)
    return made


def _shown(found: Found) -> list[str]:
    """Return all that is reported of findings."""
    sarif = formats.render_sarif(found.findings, found.allowed, None)
    texts = [formats.render_json(found.findings, found.allowed), sarif]
    choices = [edit for each in found.findings for edit in each.choices]
    edits = [(each.span.file, each.span.line, each.span.column, each.text) for each in choices]
    texts += [str(edits), formats.render_github(found.findings)]
    return [*texts, f"{found.files} {found.named}"]


@pytest.mark.slow
@pytest.mark.parametrize("case", sorted(CASES.glob("DRS*")), ids=lambda each: each.name)
def test_findings_are_those_of_a_new_check(case: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Every kind of finding comes back with its places, hints and fixes."""
    monkeypatch.chdir(CASES)
    anew = find([case.name], (), anew=True)
    find([case.name], ())
    made = _checks(monkeypatch)
    assert _shown(find([case.name], ())) == _shown(anew)
    assert made == []


def test_all_kinds_of_allowances_are_recalled(
    project: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """By a comment, and by the project."""
    entry = '[[allow]]\ncode = "DRS210"\npath = "**"\nreason = "made by hand"\n'
    (project / "deros.toml").write_text(entry)
    first = find(["."], ())
    made = _checks(monkeypatch)
    assert _shown(find(["."], ())) == _shown(first)
    assert made == []
    assert {type(each.by).__name__ for each in first.allowed} <= {"Allowance", "ProjectAllowance"}


# What findings rest on ----------------------------------------------------------------------------


def _same_size_and_time(folder: Path) -> None:
    file = folder / "robot.system"
    before = file.stat()
    file.write_text(SYSTEM.replace("image to /image", "image to /imagf"))
    os.utime(file, ns=(before.st_atime_ns, before.st_mtime_ns))


def _imported(folder: Path) -> None:
    (folder / "nodes/camera.rnd").write_text(NODE.replace("topic image", "topic picture"))


def _joins_the_glob(folder: Path) -> None:
    (folder / "nodes/extra.rnd").write_text("node")


def _named_file(folder: Path) -> None:
    (folder / "calibration/left.yaml").touch()


def _parameter_file(folder: Path) -> None:
    (folder / "camera.yaml").write_text("camera:\n  ros__parameters:\n    rate: fast\n")


def _launch_file(folder: Path) -> None:
    (folder / "tools.launch.xml").write_text('<launch><arg name="speed"/></launch>')


def _project_file(folder: Path) -> None:
    (folder.parent / "deros.toml").write_text("nothing = 1\n")


def _shared_project_file(folder: Path) -> None:
    (folder.parent / "pyproject.toml").write_text("[tool.deros]\nnothing = 1\n")


def _package_with_messages(folder: Path) -> None:
    share = folder.parents[1] / "prefix/share"
    index = share / "ament_index/resource_index/rosidl_interfaces"
    index.mkdir(parents=True)
    (index / "robot_msgs").touch()
    (share / "robot_msgs/msg").mkdir(parents=True)
    (share / "robot_msgs/msg/State.msg").write_text("bool on\n")


def _package_with_a_file(folder: Path) -> None:
    share = folder.parents[1] / "prefix/share"
    (share / "ament_index/resource_index/packages").mkdir(parents=True)
    (share / "ament_index/resource_index/packages/robot_bringup").touch()
    (share / "robot_bringup").mkdir()


CHANGES = [
    _same_size_and_time,
    _imported,
    _joins_the_glob,
    _named_file,
    _parameter_file,
    _launch_file,
    _project_file,
    _shared_project_file,
    _package_with_messages,
    _package_with_a_file,
    lambda folder: (folder / "robot.system").unlink(),
    lambda folder: (folder / "nodes/camera.rnd").unlink(),
]


@pytest.mark.parametrize("named", ["robot.system", "."])
@pytest.mark.parametrize("change", CHANGES)
def test_changes_are_seen(project: Path, change: Callable[[Path], None], named: str) -> None:
    """Each of these changes the findings, so that recalled ones would be wrong."""
    if named == "." and change is CHANGES[-2]:
        (project / "other.system").write_text("system Other")
    before = _shown(find([named], ()))
    assert Memory([named], ()).recall() is not None
    change(project)
    assert Memory([named], ()).recall() is None
    after = _shown(find([named], ()))
    assert after == _shown(find([named], (), anew=True))
    assert after != before


def test_messages_that_change_are_seen(project: Path) -> None:
    """Definitions of the project's interfaces are read, too."""
    (project / "messages/robot_msgs/msg").mkdir(parents=True)
    message = project / "messages/robot_msgs/msg/State.msg"
    message.write_text("bool on\n")
    interfaces = (project / "messages",)
    before = _shown(find(["robot.system"], interfaces))
    message.write_text("bool 1on\n")
    after = _shown(find(["robot.system"], interfaces))
    assert after != before
    assert after == _shown(find(["robot.system"], interfaces, anew=True))


def test_findings_are_those_of_one_question(
    project: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Other files, other interfaces, another folder: another check."""
    find(["robot.system"], ())
    assert Memory(["nodes/camera.rnd"], ()).recall() is None
    assert Memory(["robot.system"], (tmp_path,)).recall() is None
    monkeypatch.chdir(project.parent)
    assert Memory(["robot.system"], ()).recall() is None


def test_environment_counts(project: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Another prefix may have other packages."""
    assert project.is_dir()
    find(["robot.system"], ())
    monkeypatch.setenv("AMENT_PREFIX_PATH", str(tmp_path / "other"))
    assert Memory(["robot.system"], ()).recall() is None


@pytest.mark.usefixtures("project")
def test_libraries_count(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """A library that is installed or replaced changes the folder that it lies in."""
    libraries = tmp_path / "site-packages"
    libraries.mkdir()
    monkeypatch.syspath_prepend(str(libraries))
    find(["robot.system"], ())
    assert Memory(["robot.system"], ()).recall() is not None
    (libraries / "textX-99.dist-info").mkdir()
    os.utime(libraries, (1, 1))
    assert Memory(["robot.system"], ()).recall() is None


@pytest.mark.usefixtures("project")
def test_program_counts(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """An update of deros checks anew."""
    package = tmp_path / "deros"
    shutil.copytree(Path(remembered.__file__).parent, package / "pipeline")
    monkeypatch.setattr(remembered, "__file__", str(package / "pipeline/remembered.py"))
    find(["robot.system"], ())
    assert Memory(["robot.system"], ()).recall() is not None
    (package / "pipeline/outcome.py").write_text("# another version\n")
    assert Memory(["robot.system"], ()).recall() is None


@pytest.mark.usefixtures("project")
def test_update_during_a_check_counts(monkeypatch: pytest.MonkeyPatch) -> None:
    """What the program of before has found is not what that of now finds."""
    genuine = command._checked

    def updated(files: list[str], interfaces: list[Path]) -> Found:
        monkeypatch.setattr(remembered, "_FORMAT", "another version")
        return genuine(files, interfaces)

    monkeypatch.setattr(command, "_checked", updated)
    find(["robot.system"], ())
    assert Memory(["robot.system"], ()).recall() is None


def test_generators_of_others_are_asked_each_time(
    project: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """What they read is not known."""

    def refusing(model: Any, context: Context, options: Options) -> Files:
        del model, context, options
        return {}

    monkeypatch.setattr(refusing, "__module__", "somebody.generator")
    foreign = Generator("rosnode", "python", refusing, ())
    monkeypatch.setattr(Registry, "find", lambda *_: foreign)
    (project / "deros.toml").write_text('[targets]\nrnd = "python"\n')
    camera = NODE.replace("  topic state : robot_msgs.State\n", "")
    (project / "nodes/camera.rnd").write_text(camera)
    found = find(["nodes/camera.rnd"], ())
    assert [each for each in found.findings if each.is_error] == []
    assert Memory(["nodes/camera.rnd"], ()).recall() is None


# The file itself ----------------------------------------------------------------------------------


@pytest.mark.usefixtures("project")
@pytest.mark.parametrize(
    "damage",
    [
        lambda _: "",
        lambda text: text[: len(text) // 2],
        lambda text: text.replace("DRS", "DRX"),
        lambda _: "\x80",
        lambda _: _signed("[]"),
        lambda _: _signed("{}"),
        lambda text: _signed(text.partition("\n")[2].replace("DRS", "DRX")),
        lambda text: _signed(text.partition("\n")[2].replace('"sources":[', '"sources":[0,')),
    ],
)
def test_damaged_files_are_not_used(cache: Path, damage: Callable[[str], str]) -> None:
    """The check is made as if there were none."""
    before = _shown(find(["robot.system"], ()))
    (file,) = cache.iterdir()
    file.write_text(damage(file.read_text()), encoding="latin-1")
    assert Memory(["robot.system"], ()).recall() is None
    assert _shown(find(["robot.system"], ())) == before
    assert Memory(["robot.system"], ()).recall() is not None


def _signed(body: str) -> str:
    return f"{remembered._digest(body)}\n{body}"


@pytest.mark.usefixtures("project")
def test_without_a_place_each_check_is_made(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """A file in the way, a folder that cannot be made, no home at all."""
    (tmp_path / "cache").touch()
    assert _shown(find(["robot.system"], ())) == _shown(find(["robot.system"], (), anew=True))
    monkeypatch.setenv("XDG_CACHE_HOME", "relative")
    monkeypatch.setattr(Path, "home", _homeless)
    assert _shown(find(["robot.system"], ())) == _shown(find(["robot.system"], (), anew=True))


def _homeless() -> Path:
    raise RuntimeError("no home")


def test_only_the_user_can_read_and_only_the_newest_stay(
    project: Path, cache: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """They hold texts of the models; those used least recently go first."""
    monkeypatch.setattr(remembered, "_MOST_FILES", 2)
    for number in range(4):
        (project / f"{number}.system").write_text(f"system S{number}")
        find([f"{number}.system"], ())
    assert Memory(["3.system"], ()).recall() is not None
    assert Memory(["0.system"], ()).recall() is None
    assert [each.stat().st_mode & 0o777 for each in cache.iterdir()] == [0o600, 0o600]
    assert cache.stat().st_mode & 0o777 == 0o700


@pytest.mark.usefixtures("project")
def test_option_checks_anew(cache: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """With it, findings are neither used nor kept."""
    first = deros("check", "robot.system")
    made = _checks(monkeypatch)
    assert deros("check", "robot.system") == first
    assert made == []
    assert deros("check", "robot.system", "--no-cache") == first
    assert len(made) == 1
    shutil.rmtree(cache)
    deros("check", "robot.system", "--no-cache")
    assert not cache.exists()


@pytest.mark.usefixtures("project")
def test_long_findings_are_not_kept(cache: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """To read them again would take as long as to check."""
    monkeypatch.setattr(remembered, "_LARGEST", 1000)
    find(["robot.system"], ())
    assert list(cache.iterdir()) == []


# Whether all is asked in one place ----------------------------------------------------------------


@pytest.mark.parametrize("folder", ["cases", "golden", "../examples"])
def test_checks_ask_nothing_that_is_not_recorded(
    folder: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Whatever looks at a file of the user past the record would let a stale finding live."""
    here = (CASES.parent / folder).resolve()
    models = _models(here)
    touched: set[str] = set()
    for name in ("stat", "lstat", "open", "scandir", "listdir", "readlink"):
        monkeypatch.setattr(os, name, _noting(getattr(os, name), touched))
    monkeypatch.chdir(here)
    with recorded() as answers:
        command._checked(models, ())
    asked = {_absolute(path) for _, path, _ in answers}
    monkeypatch.undo()
    above = {str(parent) for path in asked for parent in Path(path).parents}
    inside = {path for path in touched if _is_of_the_user(path)}
    assert inside
    assert inside - asked - above == set()


def _absolute(path: str | os.PathLike[str]) -> str:
    return os.path.normpath(Path.cwd() / path)


def _models(folder: Path) -> list[str]:
    found = [each for each in folder.rglob("*") if each.suffix in (".rnd", ".system", ".deros")]
    assert found
    return sorted(map(str, found))


def _is_of_the_user(path: str) -> bool:
    """Return whether deros did not bring a file, and no library."""
    root, place = CASES.parents[1], Path(path)
    libraries = (root / "src", Path(sys.prefix, "lib"), Path(sys.prefix, "bin"))
    return place.is_relative_to(root) and not any(map(place.is_relative_to, libraries))


def _noting(genuine: Callable[..., object], touched: set[str]) -> Callable[..., object]:
    def noting(path: object = ".", *others: object, **named: object) -> object:
        if isinstance(path, str | os.PathLike):
            touched.add(_absolute(path))
        return genuine(path, *others, **named)

    return noting
