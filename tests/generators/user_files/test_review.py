"""Review of user files after a change of the model."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import pytest

from deros import codes
from deros.diagnostics import Diagnostic
from deros.generators.api.protocol import Context, Files
from deros.generators.api.registry import discover
from deros.generators.user_files.review import review, users_files
from deros.interfaces.store import InterfaceStore
from deros.metamodels.load import Repository
from deros.models.node import NodeType
from tests.support.rules import embedded_store, load

OLD = """node base : robot
parameters
  name speed : double = 1.0
publishes
  topic odom : nav_msgs.Odometry
subscribes
  topic front : sensor_msgs.LaserScan
services
  service reset : std_srvs.Trigger
timers
  timer control every 20 ms
"""
LANGUAGES = ("python", "cpp")


def _files(model: str, language: str) -> Files:
    context = Context(InterfaceStore(prefixes=()), Repository())
    loaded = context.repository.load_text("base.rnd", model)
    assert isinstance(loaded.model, NodeType), loaded.diagnostics
    generator = discover().find("rosnode", language)
    assert generator is not None
    return generator(loaded.model, context, {})


def _write(files: Files, folder: Path) -> None:
    for path, file in files.items():
        target = folder / path
        target.parent.mkdir(parents=True, exist_ok=True)
        target.write_text(file.text)


def _review(new: str, language: str, folder: Path) -> list[Diagnostic]:
    files = _files(new, language)
    return review(files, users_files(files, folder))


@pytest.fixture(params=LANGUAGES)
def language(request: pytest.FixtureRequest) -> str:
    """Return each language of nodes."""
    return str(request.param)


def _words(found: list[Diagnostic]) -> set[tuple[str, str]]:
    """Return the codes with the texts that they point at."""
    return {(each.code.name, each.span.text) for each in found}


def test_generated_user_files_have_no_findings(language: str, tmp_path: Path) -> None:
    """There are none, before or after the user fills them in."""
    _write(_files(OLD, language), tmp_path)
    assert _review(OLD, language, tmp_path) == []


def test_missing_handler_is_reported(tmp_path: Path) -> None:
    """The span is the name of the class, and the message names the method."""
    _write(_files(OLD, "python"), tmp_path)
    new = OLD.replace("services", "  topic rear : sensor_msgs.LaserScan\nservices")
    (finding,) = _review(new, "python", tmp_path)
    assert (finding.code, finding.span.text) == (codes.MISSING_METHOD, "Base")
    assert "'on_rear'" in finding.message


@pytest.mark.parametrize(
    ("change", "old", "new"),
    [
        (("topic front", "topic rear"), "on_front", "on_rear"),
        (("service reset", "service restart"), "handle_reset", "handle_restart"),
        (("timer control", "timer drive"), "on_control", "on_drive"),
    ],
)
def test_renamed_port_suggests_a_rename(
    tmp_path: Path, change: tuple[str, str], old: str, new: str
) -> None:
    """The old and the new method refer to each other."""
    _write(_files(OLD, "python"), tmp_path)
    findings = _review(OLD.replace(*change), "python", tmp_path)
    assert _words(findings) == {("DRS407", "Base"), ("DRS408", old)}
    by_code = {each.code.name: each for each in findings}
    assert by_code["DRS408"].hint == f"rename it to '{new}'"
    assert by_code["DRS407"].hint.startswith(f"rename '{old}' in line ")


def test_method_of_a_removed_port_is_reported(tmp_path: Path) -> None:
    """The span is the method, which is never called."""
    _write(_files(OLD, "python"), tmp_path)
    new = OLD.replace("subscribes\n  topic front : sensor_msgs.LaserScan\n", "")
    assert _words(_review(new, "python", tmp_path)) == {("DRS408", "on_front")}


def test_uses_of_removed_ports_and_parameters_are_reported(tmp_path: Path) -> None:
    """They are reported where the code uses them."""
    _write(_files(OLD, "python"), tmp_path)
    path = tmp_path / "robot/robot/base.py"
    line = "self.publish_odom(self.parameters.speed)"
    path.write_text(path.read_text().replace("self.get_logger()", f"{line}\n        self.x()", 1))
    assert _review(OLD, "python", tmp_path) == []
    new = OLD.replace("topic odom", "topic odometry").replace("name speed", "name velocity")
    findings = _review(new, "python", tmp_path)
    assert _words(findings) == {("DRS408", "publish_odom"), ("DRS408", "speed")}
    hints = {each.span.text: each.hint for each in findings}
    assert hints["publish_odom"] == "did you mean 'publish_odometry'?"


@pytest.mark.parametrize("helper", ["on_button", "front_of", "handle_joy"])
def test_other_methods_of_the_user_are_ignored(tmp_path: Path, helper: str) -> None:
    """Methods called by user code, and hooks of ROS 2, do not belong to ports."""
    _write(_files(OLD, "python"), tmp_path)
    path = tmp_path / "robot/robot/base.py"
    own = (
        f"    def {helper}(self) -> None:\n        self.{helper}()\n\n"
        "    def on_parameters_changed(self, previous: object) -> None:\n        pass\n\n"
        "    def on_front"
    )
    path.write_text(path.read_text().replace("    def on_front", own))
    assert _review(OLD, "python", tmp_path) == []


def test_inherited_and_assigned_methods_are_not_missing(tmp_path: Path) -> None:
    """A base class in another file, or an assignment, may provide the method."""
    _write(_files(OLD, "python"), tmp_path)
    path = tmp_path / "robot/robot/base.py"
    text = path.read_text()
    new = OLD.replace("services", "  topic rear : sensor_msgs.LaserScan\nservices")
    path.write_text(text.replace("class Base(BaseBase)", "class Base(Mixin, BaseBase)"))
    assert _review(new, "python", tmp_path) == []
    path.write_text(text.replace("    def on_front", "    on_rear = print\n\n    def on_front"))
    assert _review(new, "python", tmp_path) == []
    own = "class Mixin:\n    def on_rear(self, msg):\n        pass\n\n\nclass Base(Mixin, BaseBase)"
    path.write_text(text.replace("class Base(BaseBase)", own))
    assert _review(new, "python", tmp_path) == []


def test_missing_functions_of_user_modules_are_reported(tmp_path: Path) -> None:
    """Without main() the program does not start; it may also be imported or assigned."""
    _write(_files(OLD, "python"), tmp_path)
    path = tmp_path / "robot/robot/base.py"
    text = path.read_text()
    path.write_text(text.replace("def main(", "def start("))
    (finding,) = _review(OLD, "python", tmp_path)
    assert finding.code is codes.MISSING_METHOD
    assert "'base.py' has no function 'main'" in finding.message
    for more in ("main = start\n", "from robot.other import main\n", "from robot.other import *\n"):
        path.write_text(text.replace("def main(", "def start(") + more)
        assert _review(OLD, "python", tmp_path) == []


@pytest.mark.parametrize("text", ["class (", "\0", "from x import *\n", "(" * 1000])
def test_unreadable_user_file_is_ignored(tmp_path: Path, text: str) -> None:
    """Its compiler or interpreter will report the error."""
    for language in LANGUAGES:
        _write(_files(OLD, "python"), tmp_path / language)
        for path in users_files(_files(OLD, "python"), tmp_path / language).values():
            if path.name != "package.xml":
                path.write_text(text)
        assert _review(OLD, "python", tmp_path / language) == []


def test_spans_count_characters_in_any_alphabet(tmp_path: Path) -> None:
    """The parser counts bytes, diagnostics count characters."""
    _write(_files(OLD, "python"), tmp_path)
    path = tmp_path / "robot/robot/base.py"
    path.write_text(f"# Übergröße 名前\n{path.read_text()}")
    findings = _review(OLD.replace("topic front", "topic rear"), "python", tmp_path)
    assert _words(findings) == {("DRS407", "Base"), ("DRS408", "on_front")}


def test_missing_dependency_in_package_xml_is_reported(language: str, tmp_path: Path) -> None:
    """A new port needs it; additions of the user are ignored."""
    _write(_files(OLD, language), tmp_path)
    path = tmp_path / "robot/package.xml"
    path.write_text(path.read_text().replace("</package>", "  <depend>own</depend>\n</package>"))
    new = OLD.replace("services", "  topic imu : geometry_msgs.Twist\nservices")
    findings = [each for each in _review(new, language, tmp_path) if each.code.name == "DRS409"]
    assert [each.message for each in findings] == [
        "package.xml lacks what the generated code needs: geometry_msgs"
    ]
    assert "depend>geometry_msgs</" in findings[0].hint


@pytest.mark.parametrize(
    ("change", "part"),
    [
        (lambda text: text.replace("<name>robot<", "<name>other<"), "is of the package 'other'"),
        (lambda text: text.replace("type>ament_", "type>other_"), "has the build type 'other_"),
        (lambda text: text.replace("</package>", ""), "cannot be read"),
    ],
)
def test_package_xml_must_fit(
    language: str, tmp_path: Path, change: Callable[[str], str], part: str
) -> None:
    """Another name or build type, and invalid XML, are reported."""
    _write(_files(OLD, language), tmp_path)
    path = tmp_path / "robot/package.xml"
    path.write_text(change(path.read_text()))
    (finding,) = _review(OLD, language, tmp_path)
    assert finding.code is codes.INCOMPLETE_MANIFEST
    assert part in finding.message


RULES = """action horn;
action lights;
input v = topic /scan.range_max timeout 1 sec
entity e { far: v > 1.0 or v.missing(); }
if e.far then { horn; lights; };
"""


def test_actions_of_a_safety_node_are_reviewed(tmp_path: Path) -> None:
    """Code of an action that the rules no longer have is reported at its place."""
    generator = discover().find("deros", "python")
    assert generator is not None
    context = Context(embedded_store(), Repository())
    files = generator(load(RULES), context, {"package": "r_safety"})
    _write(files, tmp_path)
    assert review(files, users_files(files, tmp_path)) == []
    files = generator(load(RULES.replace("lights", "lamp")), context, {"package": "r_safety"})
    findings = review(files, users_files(files, tmp_path))
    assert {("DRS408", "lights"), ("DRS407", "RSafetyNodeActions")} <= _words(findings)


def test_compiler_reviews_what_is_written_in_cpp(tmp_path: Path) -> None:
    """The class is abstract without a method, and 'override' marks one that the base has not."""
    _write(_files(OLD, "cpp"), tmp_path)
    header = (tmp_path / "robot/include/robot/base.hpp").read_text()
    assert all(" override;" in line for line in header.splitlines() if "  void on_" in line)
    new = OLD.replace("topic front", "topic rear")
    assert _review(new, "cpp", tmp_path) == []
    base = _files(new, "cpp")["robot/include/robot/base_base.hpp"].text
    assert "virtual void on_rear(" in base
    assert "on_front" not in base
