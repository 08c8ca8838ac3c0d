"""Changes of node types: each is found once, on the right side, and breaks whom it breaks."""

from __future__ import annotations

import re
from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path
from typing import Any

import pytest

from deros.diff.changes import Change
from deros.diff.models import Side, compare_models
from deros.diff.nodes import compare_node_types
from deros.generators.node.description import node_description
from deros.metamodels.load import Repository
from deros.models.node import NodeType
from tests.support.compared_models import with_edit

ROOT = Path(__file__).resolve().parents[2]

NODE = """\
node base : drivers "drives"
executable "base_main"
plugin "drivers::Base"
lifecycle
parameters open
  name rate : double = 10.0 [m/s] in [1.0, 20.0] "how often"
  name mode : string = "auto" one_of ["auto", "manual"]
  name joints : string[] = ["a", "b"] min_size 1 max_size 4
  name device : string
publishes
  topic odom : nav_msgs.Odometry { twist.twist.linear.x [m/s] } qos reliable depth 10
  topic /tf : tf2_msgs.TFMessage { frame odom -> base_link }
subscribes
  topic cmd_vel : geometry_msgs.Twist stops after 500 ms qos best_effort
services
  service reset : std_srvs.Trigger
timers
  timer tick every 10 ms
"""


def load(text: str) -> NodeType:
    """Return the node type of a text without faults."""
    loaded = Repository().load_text("base.rnd", text)
    assert not loaded.diagnostics, loaded.diagnostics
    assert isinstance(loaded.model, NodeType)
    return loaded.model


def changes(old: str, new: str) -> list[Change]:
    """Return the changes from one text to another."""
    return list(compare_node_types(load(old), load(new)))


def edited(old: str, new: str) -> str:
    """Return the node with one edit."""
    return with_edit(NODE, old, new)


EDITS = [
    # part, name, aspect, text, its replacement, breaks, breaks the other way round
    ("node type", "base", "package", ": drivers ", ": motors ", True, True),
    ("node type", "base", "executable", "base_main", "main", True, True),
    ("node type", "base", "plugin", 'plugin "drivers::Base"\n', "", True, False),
    ("node type", "base", "lifecycle", "lifecycle\n", "", True, True),
    ("node type", "base", "takes any parameter", "parameters open", "parameters", True, False),
    ("node type", "base", "description", '"drives"', '"moves"', False, False),
    ("parameter", "rate", "default", "= 10.0", "= 11.0", False, False),
    ("parameter", "rate", "default", " = 10.0", "", True, False),
    ("parameter", "rate", "unit", "10.0 [m/s]", "10.0 [cm/s]", True, True),
    ("parameter", "rate", "range", "[1.0, 20.0]", "[1.0, 15.0]", True, False),
    ("parameter", "rate", "range", "[1.0, 20.0]", "(1.0, 20.0]", True, False),
    ("parameter", "rate", "range", " in [1.0, 20.0]", "", False, True),
    ("parameter", "rate", "description", '"how often"', "", False, False),
    ("parameter", "rate", "read_only", ' "how often"', ' read_only "how often"', True, False),
    ("parameter", "mode", "choices", '["auto", "manual"]', '["auto"]', True, False),
    ("parameter", "mode", "choices", ' one_of ["auto", "manual"]', "", False, True),
    ("parameter", "joints", "number of elements", "min_size 1", "min_size 2", True, False),
    ("parameter", "joints", "number of elements", "max_size 4", "max_size 3", True, False),
    ("parameter", "joints", "unique", "max_size 4", "max_size 4 unique", True, False),
    ("parameter", "joints", "custom checks", "max_size 4", 'max_size 4 custom "a::b"', True, False),
    ("parameter", "device", "type", "device : string", "device : integer", True, True),
    ("publisher", "odom", "type", "nav_msgs.Odometry", "geometry_msgs.TwistStamped", True, True),
    ("publisher", "odom", "QoS reliability", "reliable", "best_effort", True, False),
    ("publisher", "odom", "QoS durability", "reliable", "reliable transient_local", False, True),
    ("publisher", "odom", "QoS deadline", "reliable", "reliable deadline 1 sec", False, True),
    ("publisher", "odom", "QoS depth", "depth 10", "depth 5", False, False),
    ("publisher", "odom", "units", "[m/s] }", "[cm/s] }", True, True),
    ("publisher", "odom", "units", " { twist.twist.linear.x [m/s] }", "", True, False),
    ("publisher", "/tf", "frames", "odom -> base_link", "odom -> base", True, True),
    ("subscriber", "cmd_vel", "QoS reliability", "best_effort", "reliable", True, False),
    ("subscriber", "cmd_vel", "stops after", "500 ms", "400 ms", True, False),
    ("subscriber", "cmd_vel", "stops after", " stops after 500 ms", "", False, True),
    ("service", "reset", "type", "std_srvs.Trigger", "std_srvs.Empty", True, True),
    ("timer", "tick", "period", "10 ms", "20 ms", False, False),
]


@pytest.mark.parametrize(("part", "name", "aspect", "old", "new", "breaks", "back"), EDITS)
def test_edit_of_an_aspect_is_found_once(
    part: str, name: str, aspect: str, old: str, new: str, breaks: bool, back: bool
) -> None:
    """It is reported with its part, and breaks somebody in one or both directions."""
    other = edited(old, new)
    (there,) = changes(NODE, other)
    assert (there.kind, there.part, there.name, there.aspect) == ("changed", part, name, aspect)
    assert bool(there.breaks) == breaks, there
    (again,) = changes(other, NODE)
    assert (again.part, again.name, again.aspect) == (part, name, aspect)
    assert bool(again.breaks) == back, again
    assert (again.old, again.new) == (there.new, there.old)


PARTS = [
    # part, name, its line, whether a new one breaks somebody, whether the loss of one does
    ("parameter", "mode", '  name mode : string = "auto" one_of ["auto", "manual"]\n', False, True),
    ("parameter", "device", "  name device : string\n", True, True),
    ("publisher", "/tf", "  topic /tf : tf2_msgs.TFMessage { frame odom -> base_link }\n", 0, 1),
    ("service", "reset", "services\n  service reset : std_srvs.Trigger\n", False, True),
    ("timer", "tick", "timers\n  timer tick every 10 ms\n", False, False),
]


@pytest.mark.parametrize(("part", "name", "line", "new_breaks", "loss_breaks"), PARTS)
def test_part_in_one_version_only_is_found_once(
    part: str, name: str, line: str, new_breaks: bool, loss_breaks: bool
) -> None:
    """It is removed from one side, or added to the other, with its place there."""
    without = edited(line, "")
    (gone,) = changes(NODE, without)
    assert (gone.kind, gone.part, gone.name) == ("removed", part, name)
    assert gone.old_span is not None
    assert gone.new_span is None
    assert gone.old_span.text == name
    assert bool(gone.breaks) == loss_breaks
    (come,) = changes(without, NODE)
    assert (come.kind, come.part, come.name) == ("added", part, name)
    assert come.old_span is None
    assert come.new_span is not None
    assert bool(come.breaks) == new_breaks


def _examples() -> Sequence[Path]:
    return sorted((ROOT / "examples").rglob("*.rnd"))


@pytest.mark.parametrize("path", _examples(), ids=lambda path: path.stem)
def test_printed_and_reversed_node_type_is_unchanged(path: Path) -> None:
    """Layout, comments, and the order of ports and parameters mean nothing."""
    loaded = Repository().load(path)
    assert isinstance(loaded.model, NodeType)
    written = replace(loaded.model, plugin=None)  # the printer leaves it out
    printed = node_description(written)
    assert not list(compare_node_types(written, load(printed)))
    head, *sections = re.split(r"^(?=[a-z])", printed, flags=re.MULTILINE)[1:]
    turned = [
        "".join([s.splitlines(keepends=True)[0], *reversed(s.splitlines(keepends=True)[1:])])
        for s in sections
        if s.startswith("  ", s.find("\n") + 1)
    ]
    kept = [s for s in sections if not s.startswith("  ", s.find("\n") + 1)]
    assert not list(compare_node_types(written, load("".join([head, *kept, *turned]))))


@pytest.mark.parametrize("path", _examples(), ids=lambda path: path.stem)
def test_each_part_that_an_example_loses_is_found_alone(path: Path) -> None:
    """Whatever is dropped of a real node type, exactly that is reported, as removed and added."""
    whole = Repository().load(path).model
    assert isinstance(whole, NodeType)
    for name in ("parameters", "ports", "timers"):
        parts = getattr(whole, name)
        for place, part in enumerate(parts):
            kept: dict[str, Any] = {name: (*parts[:place], *parts[place + 1 :])}
            without = replace(whole, **kept)
            (gone,) = compare_node_types(whole, without)
            assert (gone.kind, gone.old_span) == ("removed", part.name_span)
            (come,) = compare_node_types(without, whole)
            assert (come.kind, come.new_span) == ("added", part.name_span)


@pytest.mark.parametrize(
    ("one", "other"), [("m/s", "m*s^-1"), ("rad/s", "rad * s**-1"), ("m/s^2", "m/s2")]
)
def test_unit_spelled_otherwise_is_no_change(one: str, other: str) -> None:
    """A unit is compared by its meaning."""
    text = "node a : b parameters name x : double = 1.0 [{}]"
    assert changes(text.format(one), text.format(other)) == []


def test_models_of_one_name_correspond_when_their_file_has_moved() -> None:
    """A moved file is no change; the changes in it are found all the same."""
    old, new = load(NODE), load(edited("500 ms", "400 ms"))
    before = [
        Side("a/base.rnd", "a/base.rnd", old),
        Side("x.rnd", "x.rnd", load("node x : extras")),
    ]
    after = [Side("b/base.rnd", "b/base.rnd", new), Side("y.rnd", "y.rnd", load("node y : extras"))]
    found = list(compare_models(before, after))
    assert [(each.old, each.new, len(each.changes)) for each in found] == [
        ("a/base.rnd", "b/base.rnd", 1),
        ("x.rnd", None, 1),
        (None, "y.rnd", 1),
    ]
    assert [bool(each.breaking) for each in found] == [True, True, False]
