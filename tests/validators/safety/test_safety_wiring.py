"""Hand-wired safety nodes and gates, and ``safety`` statements, checked against their rules."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

import pytest

from deros.diagnostics import Diagnostic
from tests.support.checks import checked
from tests.support.cli import deros
from tests.support.hand_wired import DIFFERENCES, RULES, STATEMENT, write_hand_wired

pytestmark = pytest.mark.usefixtures("own_folder")


def findings(*files: str) -> list[Diagnostic]:
    """Return the findings of ``deros check`` on the files."""
    return checked(*(files or ("robot.system",)))


def codes(*files: str) -> list[str]:
    """Return the codes of all findings."""
    return [finding.code.name for finding in findings(*files)]


def edit(path: str, *changes: tuple[str, str]) -> None:
    """Replace texts in a file, each of which must occur."""
    text = Path(path).read_text(encoding="utf-8")
    for old, new in changes:
        assert old in text, old
        text = text.replace(old, new, 1)
    Path(path).write_text(text, encoding="utf-8")


# Hand-wired safety nodes --------------------------------------------------------------------------


@pytest.mark.parametrize("file", ["robot.system", "robot.deros"])
def test_sound_hand_wiring_has_no_findings(file: str) -> None:
    """The result is the same whether the system or the rules next to it are named."""
    write_hand_wired()
    assert findings(file) == []


@pytest.mark.parametrize("name", DIFFERENCES)
@pytest.mark.parametrize("file", ["robot.system", "robot.deros"])
def test_wiring_difference_is_an_error_with_both_places(name: str, file: str) -> None:
    """The span is in the system; the related span is the line in the rules."""
    old, new, code, words = DIFFERENCES[name]
    write_hand_wired()
    edit("robot.system", (old, new))
    reported = [finding for finding in findings(file) if finding.code.name == code]
    assert len(reported) == (2 if "swap" in name else 1), findings(file)
    assert words in reported[0].message
    assert reported[0].is_error
    assert reported[0].span.file == "robot.system"
    assert reported[0].related


def test_relative_name_in_a_namespace_is_another_topic() -> None:
    """The namespace around the safety node changes the topics it is connected to."""
    write_hand_wired()
    edit(
        "robot.system",
        ("subsystem Safety {", "subsystem Safety namespace /front_robot {"),
        ("connect /front to /front", "connect /front to front"),
        ("topics\n", "topics\n  external topic /front_robot/front : sensor_msgs.LaserScan\n"),
    )
    (finding,) = [each for each in findings() if each.code.name == "DRS354"]
    assert "the rules read '/front'" in finding.message
    assert "'/front_robot/front'" in finding.message


def test_namespace_of_an_import_is_a_finding_of_the_importing_system() -> None:
    """The system is sound alone; in a namespace, a relative name no longer matches the rules."""
    write_hand_wired()
    edit("robot.system", ("connect /front to /front", "connect /front to front"))
    assert findings() == []
    Path("fleet.system").write_text(
        'system Fleet imports import "robot.system"\nsubsystem one : Robot namespace /one\n'
    )
    (finding,) = [each for each in findings("fleet.system") if each.code.name == "DRS354"]
    assert "'/one/front'" in finding.message


@pytest.mark.parametrize(
    ("old", "new", "words"),
    [
        ("  topic /rear : sensor_msgs.LaserScan qos best_effort depth 10\n", "", "it lacks the"),
        ("/rear : sensor_msgs.LaserScan", "/rear : sensor_msgs.Imu", "is sensor_msgs.Imu, not"),
        (
            "/stop : std_msgs.Bool qos reliable transient_local",
            "/stop : std_msgs.Bool qos reliable",
            "the publisher '/stop' has another QoS",
        ),
        ("subscribes\n", "subscribes\n  topic /side : sensor_msgs.LaserScan\n", "'/side', which"),
        (": robot_safety ", ": other_safety ", "in the package"),
        ('robot"\n', 'robot"\nexecutable "other"\n', "its program is 'other'"),
        ("publish_freq : double = 10.0", "publish_freq : double = 50.0", "'publish_freq' has"),
        ("name lock_memory", "name old_switch : bool = true\n  name lock_memory", "'old_switch'"),
    ],
)
def test_outdated_description_is_one_finding(old: str, new: str, words: str) -> None:
    """One finding names each difference between the description and the rules."""
    write_hand_wired()
    edit("robot_safety_node.rnd", (old, new))
    reported = [each for each in findings() if each.code.name == "DRS353"]
    if "package" in words:  # the gate is then in another package
        assert any("gate" in each.span.text for each in reported)
        return
    (finding,) = reported
    assert words in finding.message
    assert "generate it again" in finding.hint


def test_outdated_description_does_not_block_generation() -> None:
    """A new input is connected while the description is old; after generation both are sound."""
    write_hand_wired()
    edit("robot.deros", ("/rear.ranges[0]", "/side.ranges[0]"))
    edit(
        "robot.system",
        ("external topic /rear :", "external topic /side :"),
        ("connect /rear to /rear", "connect /side to /side"),
    )
    assert codes() == ["DRS353"]
    outcome = deros("generate", "robot.deros", "--target", "python", "-o", "out")
    assert outcome.code == 0, outcome.err
    new = Path("out/robot_safety/robot_safety_node.rnd").read_text(encoding="utf-8")
    Path("robot_safety_node.rnd").write_text(new, encoding="utf-8")
    assert codes() == []


def test_type_mismatch_with_outdated_description_does_not_block_generation() -> None:
    """The mismatch is only a consequence of the outdated description."""
    write_hand_wired()
    edit("robot.system", ("/rear : sensor_msgs.LaserScan", "/rear : sensor_msgs.Range"))
    edit("robot.deros", ("/rear.ranges[0]", "/rear.range"))
    assert codes() == ["DRS353"]
    assert deros("generate", "robot.deros", "--target", "cpp", "-o", "out").code == 0


@pytest.mark.parametrize("target", ["python", "cpp"])
def test_missing_description_does_not_block_generation(target: str) -> None:
    """The imports that fail name the files that the generator writes."""
    write_hand_wired()
    for name in ("robot_safety_node", "command_gate"):
        Path(f"{name}.rnd").unlink()
    suffix = "_cpp" if target == "cpp" else ""
    edit(
        "robot.system",
        ("robot_safety_node.rnd", f"robot_safety_node{suffix}.rnd"),
        ("command_gate.rnd", f"command_gate{suffix}.rnd"),
        (": robot_safety_node\n", f": robot_safety_node{suffix}\n"),
        (": command_gate\n", f": command_gate{suffix}\n"),
    )
    assert codes() == ["DRS355", "DRS355"]
    assert deros("check", "robot.deros").code == 1
    outcome = deros("generate", "robot.deros", "--target", target, "-o", "out")
    assert outcome.code == 0, outcome.err
    for name in ("robot_safety_node", "command_gate"):
        path = Path(f"out/robot_safety{suffix}/{name}{suffix}.rnd")
        Path(path.name).write_text(path.read_text(encoding="utf-8"), encoding="utf-8")
    assert findings() == []


def test_empty_import_glob_does_not_block_generation() -> None:
    """The folder of generated files may be empty before the first run."""
    write_hand_wired()
    edit(
        "robot.system",
        ('import "robot_safety_node.rnd"', 'import "gen/*.rnd"'),
        ('  import "command_gate.rnd"\n', ""),
    )
    assert codes() == ["DRS355"]
    assert deros("generate", "robot.deros", "--target", "python", "-o", "out").code == 0


def test_import_glob_with_a_misspelt_folder_is_not_blamed_on_the_safety_node() -> None:
    """The folder that is meant exists; it has the descriptions of all other nodes."""
    write_hand_wired()
    Path("nodes").mkdir()
    edit("robot.system", ('import "robot_safety_node.rnd"', 'import "node/*.rnd"'))
    found = findings()
    assert [(each.code.name, each.hint) for each in found] == [
        ("DRS201", "did you mean 'nodes/*.rnd'?")
    ]


def test_other_missing_import_is_still_an_error() -> None:
    """The description of a sensor is not generated from the rules."""
    write_hand_wired()
    edit("robot.system", ("imports\n", 'imports\n  import "sensor.rnd"\n'))
    assert codes("robot.deros") == ["DRS201"]


def test_package_is_recognised_by_its_heartbeat() -> None:
    """With ``--package guard``, the only safety node belongs to the only rules."""
    write_hand_wired("guard")
    assert findings() == []
    edit("robot.system", ("connect /front to /front", "connect /front to /rear"))
    assert codes() == ["DRS354"]


def test_hint_asks_for_rules_in_another_folder() -> None:
    """They are not found automatically; when named, they are compared with the system."""
    write_hand_wired()
    Path("rules").mkdir()
    text = Path("robot.deros").read_text(encoding="utf-8")
    Path("robot.deros").unlink()
    moved = text.replace('use "', 'use "../')
    Path("rules/robot.deros").write_text(moved, encoding="utf-8")
    edit("robot.system", ("connect /front to /front", "connect /front to /rear"))
    assert codes() == ["DRS239"]
    assert codes("robot.system", "rules/robot.deros") == ["DRS354"]


def test_rules_of_another_system_are_ignored() -> None:
    """Faults of rules in the same folder that use another system are not reported."""
    write_hand_wired()
    Path("other.deros").write_text('use "nowhere.system" import Robot\naction x y z', "utf-8")
    Path("third.deros").write_text('use "sub/robot.system" import Robot\naction x', "utf-8")
    assert findings() == []


def test_second_hand_wired_instance_is_an_error() -> None:
    """Two nodes of one generated type are an error in any namespace."""
    write_hand_wired()
    edit("robot.system", ("subsystem Safety {", "subsystem Safety {\n  node again : command_gate"))
    reported = [finding for finding in findings() if finding.code.name == "DRS238"]
    assert [each.message for each in reported] == ["'/gate' is a second gate of the rules 'robot'"]


# ``safety`` statements ----------------------------------------------------------------------------


def with_statement(statement: str, more: str = "") -> None:
    """Write the system with a statement instead of the nodes."""
    write_hand_wired()
    text = Path("robot.system").read_text(encoding="utf-8")
    text = text[: text.index("subsystem Safety")].replace('  import "robot_safety_node.rnd"\n', "")
    text = text.replace('  import "command_gate.rnd"\n', "").replace("imports\n", "")
    Path("robot.system").write_text(f"{text}{statement}\n{more}", encoding="utf-8")


@pytest.mark.parametrize(
    ("modifier", "code"),
    [
        ("respawn delay 1", "DRS006"),
        ("respawn max -1", "DRS003"),
        ("log_level verbose", "DRS003"),
        ("respawn delay", "DRS003"),
    ],
)
def test_slip_in_a_statement_is_the_only_finding(modifier: str, code: str) -> None:
    """What the statement would have connected is not reported as missing."""
    with_statement(STATEMENT.replace(" as safety", f" as safety {modifier}"))
    assert codes() == [code]


@pytest.mark.parametrize("file", ["robot.system", "robot.deros"])
def test_safety_statement_has_no_findings(file: str) -> None:
    """Unconnected ports and undeclared topics of the statement are not reported."""
    with_statement(STATEMENT)
    assert findings(file) == []
    with_statement('safety "robot.deros"')
    assert findings(file) == []


def test_statement_and_hand_wired_node_are_an_error() -> None:
    """The rules would run twice."""
    with_statement('safety "robot.deros"', "node again : robot_safety_node")
    edit("robot.system", ("topics\n", 'imports\n  import "robot_safety_node.rnd"\ntopics\n'))
    by_code = {finding.code.name: finding for finding in findings()}
    assert "a second safety node of the rules 'robot'" in by_code["DRS238"].message


@pytest.mark.parametrize(
    "wiring",
    [
        "/front to /rear",
        "front to /rear",
        "/stop to /halt",
        "/wish to /elsewhere",
        "/command to /elsewhere",
        "robot_safety_node/heartbeat to /elsewhere",
    ],
)
def test_statement_cannot_rewire_topics_of_the_rules(wiring: str) -> None:
    """Such a connection could swap two inputs."""
    with_statement(f'safety "robot.deros"\nwirings connect {wiring}')
    (finding,) = [each for each in findings() if each.is_error]
    assert finding.code.name == "DRS237"


def test_faults_in_a_statement_are_reported_once() -> None:
    """Unknown ports and parameters and invalid values and names are errors of the statement."""
    with_statement(
        'safety "robot.deros" as guard package Bad-name\n'.replace("-", "__")
        + "parameters param publish_freq = 0.0 param unheard_of = 1 param use_sim_time = 3\n"
        "wirings connect ~/heart to /beat\n"
    )
    reported = [
        (finding.code.name, finding.span.text) for finding in findings() if finding.is_error
    ]
    assert sorted(reported) == [
        ("DRS204", "~/heart"),
        ("DRS206", "unheard_of"),
        ("DRS207", "3"),
        ("DRS221", "0.0"),
        ("DRS223", "Bad__name"),
    ]


def test_errors_in_the_rules_are_reported_once() -> None:
    """They are reported in the rules; nothing is reported as missing in the system."""
    with_statement('safety "robot.deros"')
    edit("robot.deros", ("front.ranges[0]", "front.rages[0]"))
    assert [(finding.code.name, finding.span.file) for finding in findings()] == [
        ("DRS302", "robot.deros")
    ]
    Path("robot.deros").write_text('use "robot.system" import Robot entity {', encoding="utf-8")
    assert codes() == ["DRS003"]


def test_two_robots_sharing_absolute_topics_are_an_error() -> None:
    """Both gates would command one drive, and both safety nodes would publish one stop."""
    with_statement('safety "robot.deros"')
    Path("fleet.system").write_text(
        'system Fleet imports import "robot.system"\n'
        "subsystem one : Robot namespace /one subsystem two : Robot namespace /two\n"
    )
    assert {"DRS339", "DRS346"} <= set(codes("fleet.system"))


def test_bypass_around_an_imported_system_is_reported() -> None:
    """The system that imports the one used by the rules is checked as well."""
    with_statement('safety "robot.deros"')
    Path("joystick.rnd").write_text("node joystick : joy publishes topic out : geometry_msgs.Twist")
    Path("fleet.system").write_text(
        'system Fleet imports import "robot.system" import "joystick.rnd"\n'
        "subsystem one : Robot\nnode joystick : joystick wirings connect out to /command\n"
    )
    by_code = {finding.code.name: finding for finding in findings("fleet.system")}
    assert "/joystick (out) bypasses the gate '/command_gate'" in by_code["DRS339"].message


def test_rules_using_two_systems_run_in_only_one() -> None:
    """Launched from both systems, the safety node would run twice."""
    with_statement('safety "robot.deros"')
    Path("yard.system").write_text('system Yard\nsafety "robot.deros"\n')
    Path("robot.deros").write_text('use "yard.system" import Yard\n' + RULES)
    assert "DRS238" in codes("robot.deros")


def test_depfile_and_launch_file_include_the_rules() -> None:
    """The rules are a prerequisite of files generated from the system."""
    with_statement('safety "robot.deros"')
    command = ("generate", "robot.system", "--target", "launch", "-o", "out", "--depfile", "d")
    assert deros(*command).code == 0
    assert f"{Path('robot.deros').resolve()}" in Path("d").read_text(encoding="utf-8")
    launch = Path("out/robot.launch.py")
    assert "'command_gate'" in launch.read_text(encoding="utf-8")
    gate = RULES[RULES.index("gate ") :]
    edit("robot.deros", (gate, ""))
    assert deros(*command).code == 0
    assert "'command_gate'" not in launch.read_text(encoding="utf-8")


def _names(text: str) -> Iterator[str]:
    return (line.split("'")[1] for line in text.splitlines() if "name=" in line)


@pytest.mark.parametrize("target", ["python", "cpp"])
def test_launched_executables_are_in_the_generated_package(target: str) -> None:
    """The generated package has the package name and executables of the launch file."""
    with_statement(f'safety "robot.deros" target {target} package guard')
    assert deros("generate", "robot.system", "--target", "launch", "-o", "out").code == 0
    assert deros("generate", "robot.deros", "--target", target, "-o", "out").code == 0
    launch = Path("out/robot.launch.py").read_text(encoding="utf-8")
    started = [
        line.split("'")[1]
        for line in launch.splitlines()
        if "package=" in line or "executable=" in line
    ]
    package = "guard_cpp" if target == "cpp" else "guard"
    suffix = "_cpp" if target == "cpp" else ""
    assert started == [package, f"guard_node{suffix}", package, f"command_gate{suffix}"]
    build = "CMakeLists.txt" if target == "cpp" else "setup.py"
    text = Path(f"out/{package}/{build}").read_text(encoding="utf-8")
    assert all(name in text for name in started)
    assert list(_names(launch)) == ["guard_node", "command_gate"]
