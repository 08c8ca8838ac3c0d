"""Changes of systems: what runs is compared, not how it is written."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path
from typing import TypeVar

import pytest

from deros.diff.changes import Change
from deros.diff.systems import compare_systems
from deros.metamodels.load import Repository
from deros.models.system import NodeInstance, Subsystem, System
from tests.support.compared_models import with_edit, without_errors

ROOT = Path(__file__).resolve().parents[2]

NODES = {
    "lidar.rnd": """
        node lidar : drivers
        parameters
          name speed : double = 1.0 [m/s]
          name frame : string = "laser"
        publishes topic scan : sensor_msgs.LaserScan qos reliable
        services service reset : std_srvs.Trigger
    """,
    "planner.rnd": """
        node planner : planning
        subscribes topic scan : sensor_msgs.LaserScan qos best_effort
        publishes topic plan : nav_msgs.Path
    """,
    "follower.rnd": """
        node follower : planning
        subscribes topic plan : nav_msgs.Path
          topic wish : geometry_msgs.Twist
        publishes topic cmd_vel : geometry_msgs.Twist
        clients client reset : std_srvs.Trigger
    """,
}

SYSTEM = """\
system Robot on base "drives"
imports
  import "*.rnd"
argument sim : bool = false
argument prefix : string = "r1"
argument mode : string = "auto" one_of ["auto", "manual"]
topics
  topic /scan
  topic /plan
  external topic /cmd_vel : geometry_msgs.Twist
  external topic /wish : geometry_msgs.Twist
host base "10.0.0.1"
host arm "10.0.0.9"
subsystem sensing namespace /front {
  node laser : lidar
    parameters param speed = 2.0
    wirings connect scan to /scan connect reset to /reset
}
node planner : planner wirings connect scan to /scan connect plan to /plan
node follower : follower when mode = "auto" respawn delay 1 sec
  wirings
    connect plan to /plan
    connect wish to /wish
    connect cmd_vel to /cmd_vel
    connect reset to /reset
process logger : "rosbag" arguments ["record"]
"""


def load(folder: Path, text: str, nodes: dict[str, str] = NODES) -> System:
    """Return a system without errors, beside node types."""
    folder.mkdir(exist_ok=True, parents=True)
    for name, content in nodes.items():
        (folder / name).write_text(content)
    (folder / "robot.system").write_text(text)
    found = without_errors(folder / "robot.system")
    assert isinstance(found, System)
    return found


def changes(folder: Path, old: str, new: str) -> list[Change]:
    """Return the changes from one text to another."""
    return list(compare_systems(load(folder / "old", old), load(folder / "new", new)))


def edited(old: str, new: str) -> str:
    """Return the system with one edit."""
    return with_edit(SYSTEM, old, new)


EDITS = [
    # part, name, aspect, text, its replacement, breaks, breaks the other way round
    ("system", "Robot", "name", "system Robot", "system Rover", True, True),
    ("system", "Robot", "description", '"drives"', '"moves"', False, False),
    ("argument", "prefix", "default", ' = "r1"', "", True, False),
    ("argument", "mode", "choices", '"manual"]', '"manual", "x"]', False, True),
    ("host", "base", "address", "10.0.0.1", "10.0.0.2", False, False),
    ("topic", "/wish", "external", "external topic /wish", "topic /wish", False, False),
    ("topic", "/plan", "rate", "topic /plan", "topic /plan rate 2 Hz", False, False),
    ("node", "/front/laser", "parameter speed", "2.0", "3.0", False, False),
    ("node", "/front/laser", "parameter frame", "2.0", '2.0 param frame = "x"', 0, 0),
    ("node", "/planner", "host", "node planner : planner", "node planner : planner on arm", 0, 0),
    ("node", "/follower", "condition", ' when mode = "auto"', "", False, True),
    ("node", "/follower", "condition", 'mode = "auto"', 'mode = "manual"', True, True),
    ("node", "/follower", "respawn", "1 sec", "2 sec", False, False),
    ("process", "logger", "program", '"rosbag"', '"ros2"', False, False),
    ("process", "logger", "words", '["record"]', '["play"]', False, False),
    ("process", "logger", "words", '["record"]', '["record", "-v" when sim]', False, False),
    ("process", "logger", "after topic", '["record"]', '["record"] after topic /plan', 0, 0),
    ("process", "logger", "after node", '["record"]', '["record"] after node planner', 0, 0),
]


@pytest.mark.parametrize(("part", "name", "aspect", "old", "new", "breaks", "back"), EDITS)
def test_edit_of_an_aspect_is_found_once(
    tmp_path: Path,
    part: str,
    name: str,
    aspect: str,
    old: str,
    new: str,
    breaks: bool,
    back: bool,
) -> None:
    """It is reported with its part, and breaks somebody in one or both directions."""
    other = edited(old, new)
    (there,) = changes(tmp_path, SYSTEM, other)
    assert (there.kind, there.part, there.name, there.aspect) == ("changed", part, name, aspect)
    assert bool(there.breaks) == breaks, there
    (again,) = changes(tmp_path, other, SYSTEM)
    assert (again.part, again.aspect) == (part, aspect)
    assert bool(again.breaks) == back, again


def _found(found: list[Change]) -> Counter[tuple[str, str, str, str, bool]]:
    return Counter((c.kind, c.part, c.name, c.aspect, bool(c.breaks)) for c in found)


def _moved(wiring: str, other: str, topic: str) -> str:
    """Return the system with one end on another topic, which is declared."""
    return edited(wiring, other).replace("topics\n", f"topics\n  topic {topic}\n")


def test_topic_that_loses_its_last_publisher_breaks_those_who_subscribe(tmp_path: Path) -> None:
    """A publisher that goes elsewhere leaves its old topic, and makes another."""
    other = _moved("scan to /scan connect reset", "scan to /raw connect reset", "/raw")
    assert _found(changes(tmp_path, SYSTEM, other)) == {
        ("changed", "topic", "/scan", "publishers", True): 1,
        ("added", "topic", "/raw", "", False): 1,
    }
    assert _found(changes(tmp_path, other, SYSTEM)) == {
        ("changed", "topic", "/scan", "publishers", False): 1,
        ("removed", "topic", "/raw", "", True): 1,
    }


def test_topic_from_outside_that_nobody_reads_breaks_those_who_publish_it(tmp_path: Path) -> None:
    """Of a topic that the system publishes itself, the last subscriber breaks nobody."""
    other = _moved("connect wish to /wish", "connect wish to /other", "/other")
    assert _found(changes(tmp_path, SYSTEM, other)) == {
        ("changed", "topic", "/wish", "subscribers", True): 1,
        ("added", "topic", "/other", "", False): 1,
    }
    other = _moved("    connect plan to /plan", "    connect plan to /other", "/other")
    assert _found(changes(tmp_path, SYSTEM, other)) == {
        ("changed", "topic", "/plan", "subscribers", False): 1,
        ("added", "topic", "/other", "", False): 1,
    }


def test_removed_node_is_found_with_the_channels_that_need_it(tmp_path: Path) -> None:
    """The channel that no other node is an end of is gone, too."""
    line = "node planner : planner wirings connect scan to /scan connect plan to /plan\n"
    assert _found(changes(tmp_path, SYSTEM, edited(line, ""))) == {
        ("removed", "node", "/planner", "", True): 1,
        ("changed", "topic", "/plan", "publishers", True): 1,
        ("changed", "topic", "/scan", "subscribers", False): 1,
    }
    assert _found(changes(tmp_path, edited(line, ""), SYSTEM)) == {
        ("added", "node", "/planner", "", False): 1,
        ("changed", "topic", "/plan", "publishers", False): 1,
        ("changed", "topic", "/scan", "subscribers", False): 1,
    }


def test_renamed_node_is_one_node(tmp_path: Path) -> None:
    """It is found by its place; the ends that it has are those of another name."""
    found = changes(tmp_path, SYSTEM, edited("namespace /front", "namespace /rear"))
    assert _found([each for each in found if each.part == "node"]) == {
        ("changed", "node", "/front/laser", "name", True): 1
    }
    assert _found([each for each in found if each.breaks]) == {
        ("changed", "node", "/front/laser", "name", True): 1
    }


@pytest.mark.parametrize(
    ("file", "old", "new", "expected"),
    [
        ("lidar.rnd", "qos reliable", "qos best_effort", ("topic", "/scan", "offered", True)),
        ("planner.rnd", "qos best_effort", "qos reliable", ("topic", "/scan", "requested", True)),
        ("lidar.rnd", ": drivers", ": motors", ("node", "/front/laser", "type", False)),
    ],
)
def test_change_of_an_imported_node_type_reaches_the_system(
    tmp_path: Path, file: str, old: str, new: str, expected: tuple[str, str, str, bool]
) -> None:
    """What a topic offers and requests comes from the types of nodes."""
    other = {**NODES, file: NODES[file].replace(old, new)}
    before, after = load(tmp_path / "a", SYSTEM), load(tmp_path / "b", SYSTEM, other)
    (found,) = compare_systems(before, after)
    assert (found.part, found.name, found.aspect.split()[0], bool(found.breaks)) == expected


def test_other_type_of_a_topic_breaks_those_who_use_it(tmp_path: Path) -> None:
    """All its ends have another type, and so has the service of a pair."""
    other = {
        name: text.replace("nav_msgs.Path", "nav_msgs.Odometry").replace("Trigger", "Empty")
        for name, text in NODES.items()
    }
    before, after = load(tmp_path / "a", SYSTEM), load(tmp_path / "b", SYSTEM, other)
    assert _found(list(compare_systems(before, after))) == {
        ("changed", "topic", "/plan", "type", True): 1,
        ("changed", "service", "/reset", "type", True): 1,
    }


SAME = [
    ("2.0", "2"),
    ("1 sec", "1000 ms"),
    ('import "*.rnd"', 'import "lidar.rnd" import "planner.rnd" import "follower.rnd"'),
    ("process logger", "// a comment\n\n  process   logger"),
    ("connect wish to /wish\n", ""),
    ("subsystem sensing namespace /front", "subsystem front namespace /front"),
    (
        "node planner : planner wirings connect scan to /scan connect plan to /plan",
        "node planner : planner wirings connect plan to plan connect scan to scan",
    ),
]


@pytest.mark.parametrize(("old", "new"), SAME)
def test_other_words_for_the_same_are_no_change(tmp_path: Path, old: str, new: str) -> None:
    """Units, durations, imports, layout, and names that resolve to the same."""
    assert changes(tmp_path, SYSTEM, edited(old, new)) == []


def test_order_of_parts_is_no_change(tmp_path: Path) -> None:
    """Nodes may stand in any order."""
    planner = "node planner : planner wirings connect scan to /scan connect plan to /plan\n"
    moved = edited(planner, "").replace("subsystem sensing", f"{planner}subsystem sensing")
    assert changes(tmp_path, SYSTEM, moved) == []


COMPUTED = """\
system Robot
imports
  import "*.rnd"
argument sim : bool = false
argument slow : bool = false
argument robot : string = "r1"
topics topic "/${robot}/scan"
node laser : lidar namespace $robot when not sim and not slow
  parameters param frame = "${robot}_laser" param speed = 1.0 when slow
  wirings connect scan to "/${robot}/scan"
"""


def test_conditions_and_texts_are_compared_as_written(tmp_path: Path) -> None:
    """What is computed from arguments stands in the report in terms of them."""
    text = COMPUTED.replace(" and not slow", "")
    (found,) = changes(tmp_path, text, text.replace("${robot}_laser", "${robot}_scan"))
    assert (found.name, found.aspect) == ("/${robot}/laser", "parameter frame")
    assert (found.old, found.new) == ('"${robot}_laser"', '"${robot}_scan"')
    (found,) = changes(tmp_path, text, text.replace("1.0 when slow", "1.0 when not slow"))
    assert (found.aspect, found.old, found.new) == (
        "parameter speed",
        "1.0 when slow",
        "1.0 when not slow",
    )
    (found,) = changes(tmp_path, COMPUTED, text.replace("when not sim", "when not slow"))
    assert (found.aspect, found.old, found.new) == (
        "condition",
        "not sim and not slow",
        "not slow",
    )
    assert not found.breaks


def test_order_in_a_condition_is_no_change(tmp_path: Path) -> None:
    """The operands of ``and`` may stand in any order."""
    other = COMPUTED.replace("not sim and not slow", "not slow and not sim")
    assert changes(tmp_path, COMPUTED, other) == []


@pytest.mark.parametrize(
    "path", sorted((ROOT / "examples").rglob("*.system")), ids=lambda path: path.stem
)
def test_example_does_not_differ_from_itself(path: Path) -> None:
    """Two loads of one file are two models that mean the same."""
    one, other = Repository().load(path).model, Repository().load(path).model
    assert isinstance(one, System)
    assert isinstance(other, System)
    assert list(compare_systems(one, other)) == []


Group = TypeVar("Group", System, Subsystem)


def _without_one(group: Group) -> Iterator[tuple[NodeInstance, Group]]:
    """Yield each node of a system or subsystem, with what is left without it."""
    for place, member in enumerate(group.members):
        members = list(group.members)
        if isinstance(member, NodeInstance):
            del members[place]
            yield member, replace(group, members=tuple(members))
            continue
        for node, rest in _without_one(member):
            members[place] = rest
            yield node, replace(group, members=tuple(members))


@pytest.mark.parametrize("name", ["feeding_robot", "intelligent_one"])
def test_each_node_that_an_example_loses_is_found_alone(name: str) -> None:
    """Of the programs, exactly the dropped one is reported; the others are channels."""
    whole = Repository().load(ROOT / "examples" / name / f"{name}.system").model
    assert isinstance(whole, System)
    dropped = list(_without_one(whole))
    assert dropped
    for node, rest in dropped:
        found = list(compare_systems(whole, rest))
        programs = [each for each in found if each.part not in ("topic", "service", "action")]
        assert [(each.kind, each.old_span) for each in programs] == [("removed", node.name_span)]


def test_value_in_a_parameter_file_is_compared(tmp_path: Path) -> None:
    """The file is an input of the system, wherever its values are written."""
    text = edited("parameters param speed = 2.0", 'parameters from "lidar.yaml"')
    values = "/front/laser:\n  ros__parameters:\n    speed: {}\n"
    (tmp_path / "a").mkdir()
    (tmp_path / "b").mkdir()
    (tmp_path / "a" / "lidar.yaml").write_text(values.format("2.0"))
    (tmp_path / "b" / "lidar.yaml").write_text("# the same\n" + values.format("3.0"))
    (found,) = compare_systems(load(tmp_path / "a", text), load(tmp_path / "b", text))
    assert (found.name, found.aspect) == ("/front/laser", "parameter speed")
    assert (found.old, found.new) == ("2.0", "3.0")
