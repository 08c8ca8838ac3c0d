"""The page on build systems: each of its snippets builds as printed."""

from __future__ import annotations

import re
import subprocess
from pathlib import Path

import pytest

from tests.support.builds import GENERATORS, Project, configured, frozen_program
from tests.support.cli import deros
from tests.support.needs import needs
from tests.support.profiles import slow

PAGE = (Path(__file__).resolve().parents[2] / "docs" / "build-systems.md").read_text("utf-8")
HEAD = "cmake_minimum_required(VERSION 3.22)\nproject(p LANGUAGES NONE)\nfind_package(deros)\n"

# Rules that need the mathematical library, like those of the documentation.
ROBOT = """\
node robot : robot_driver
publishes
  topic imu : sensor_msgs.Imu
"""
SYSTEM = """\
system robot
imports
  import "robot.rnd"
topics
  topic /imu
node robot : robot
  wirings
    connect imu to /imu
"""
RULES = """\
use "robot.system" import robot
action stop
input attitude = topic /imu.orientation timeout 1 sec
entity pose {
  tilted: attitude.tilt() > 20 deg;
  turned: attitude.yaw() > 90 deg;
  gone: attitude.missing();
}
if pose.tilted or pose.turned or pose.gone then { stop; }
"""
MAIN = """\
#include "robot_monitor.h"
void robot_emit(void *owner, int64_t t, robot_kind kind, uint32_t site)
{
  (void)owner; (void)t; (void)kind; (void)site;
}
int main(void)
{
  static robot_monitor monitor;
  robot_start(&monitor, 0, 0, 0);
  robot_on_attitude(&monitor, 1, 0.0, 0.0, 0.0, 1.0);
  return (robot_advance(&monitor, 2) > 2) ? 0 : 1;
}
"""


def _snippets(language: str) -> list[str]:
    return re.findall(rf"^```{language}\n(.*?)^```", PAGE, flags=re.DOTALL | re.MULTILINE)


def _snippet(language: str, word: str) -> str:
    (found,) = (snippet for snippet in _snippets(language) if word in snippet)
    return found


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    """Create a folder with the models of the page."""
    (tmp_path / "models").mkdir()
    for name, text in (("robot.rnd", ROBOT), ("robot.system", SYSTEM), ("robot.deros", RULES)):
        (tmp_path / "models" / name).write_text(text, encoding="utf-8")
    (tmp_path / "main.c").write_text(MAIN, encoding="utf-8")
    return tmp_path


def test_every_snippet_has_a_test() -> None:
    """A snippet added to the page needs a test here."""
    known = {
        "cmake": ("deros_add_monitor", "deros_generate", "deros_package"),
        "make": ("--depfile",),
        "python": ("deros.build",),
    }
    for language, words in known.items():
        snippets = _snippets(language)
        assert len(snippets) == len(words)
        assert all(word in text for word, text in zip(words, snippets, strict=True))


@needs("cmake", "make", "cc")
@pytest.mark.parametrize("kind", ["", slow("STATIC"), slow("OBJECT")])
def test_monitor_library_snippet_builds_and_runs(folder: Path, kind: str) -> None:
    """The project of the page compiles, links and runs, with each kind of library."""
    script = _snippet("cmake", "deros_add_monitor").replace(
        "MODEL models/robot.deros", f"MODEL models/robot.deros {kind}".rstrip()
    )
    project = configured(folder, GENERATORS[1], script)
    project.built()
    done = subprocess.run([project.build_folder / "firmware"], check=False, timeout=60)
    assert done.returncode == 0


@needs("cmake", "make")
def test_generate_snippet_builds_the_launch_file(folder: Path) -> None:
    """The target of the page generates the launch file that it installs."""
    script = HEAD + _snippet("cmake", "deros_generate")
    project: Project = configured(folder, GENERATORS[1], script)
    project.built()
    target = folder / "installed"
    command = ["cmake", "--install", str(project.build_folder), "--prefix", str(target)]
    subprocess.run(command, check=True, timeout=60, capture_output=True)
    assert (target / "share/robot/launch/robot.launch.py").is_file()


@pytest.mark.parametrize(
    ("word", "file", "model", "target"),
    [
        ("deros_package", "CMakeLists.txt", "models/odometer.rnd", "cpp"),
        ("deros.build", "setup.py", "models/robot.deros", "python"),
    ],
)
def test_scaffold_matches_the_page(
    folder: Path,
    monkeypatch: pytest.MonkeyPatch,
    word: str,
    file: str,
    model: str,
    target: str,
) -> None:
    """``--scaffold`` writes the files that the page prints."""
    monkeypatch.chdir(folder)
    odometer = "node odometer : odometry\npublishes\n  topic odom : nav_msgs.Odometry\n"
    (folder / "models/odometer.rnd").write_text(odometer, encoding="utf-8")
    outcome = deros("generate", model, "--target", target, "--scaffold", ".")
    assert outcome.code == 0, outcome.err
    language = "python" if file == "setup.py" else "cmake"
    assert (folder / file).read_text(encoding="utf-8").strip() == _snippet(language, word).strip()


@pytest.mark.slow
@needs("make")
def test_make_snippet_rebuilds_only_changes(folder: Path) -> None:
    """The rules for Make generate once, and again when a model changes."""
    (folder / "Makefile").write_text(_snippet("make", "--depfile"), encoding="utf-8")
    program = frozen_program().parent
    command = f'PATH="{program}:$PATH" make build/robot_monitor.c'

    def make() -> str:
        done = subprocess.run(
            ["/bin/sh", "-c", command],
            cwd=folder,
            capture_output=True,
            text=True,
            timeout=120,
            check=True,
        )
        return done.stdout

    assert "deros generate" in make()
    assert (folder / "build/robot_monitor.c").is_file()
    assert "deros generate" not in make()
    text = RULES.replace("20 deg", "25 deg")
    (folder / "models/robot.deros").write_text(text, encoding="utf-8")
    assert "deros generate" in make()
