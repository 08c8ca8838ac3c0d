"""A system without expressions and conditions, for given values of its arguments."""

from __future__ import annotations

from pathlib import Path

import pytest

from deros.metamodels.load import Repository
from deros.models.common import Scalar
from deros.models.system import NodeInstance, Subsystem, System
from deros.systems.arguments.resolve import resolve, resolved
from deros.systems.flatten import flatten
from tests.support.systems import load_text

CAMERA = """\
node camera : cameras
parameters
  name rate : double = 5.0
  name gains : double[] = [1.0]
  name count : integer = 1
  name label : string = "x"
publishes
  topic image : sensor_msgs.Image
"""
ARM = """\
system Arm
imports import "camera.rnd"
argument rate : double
argument name : string = "arm"
argument seen : bool = true
topics external topic "${name}_image"
node eye : camera when seen
parameters
  param rate = $rate / 2
  param label = $name
wirings connect image to "${name}_image"
"""
ROBOT = """\
argument speed : double = 2 in [0, 10]
argument n : int = 1
argument robot : string = "left"
argument slam : bool = true
topics
  external topic "/${robot}/image"
  external topic /slam when slam
subsystem front namespace $robot {
  node camera : camera namespace "cam${n}" when slam or n > 1
  parameters
    param rate = $speed * 2
    param gains = [$n, 2.5]
    param count = $n + 1 when n > 1
    param label = "${robot}_${n}"
  wirings
    connect image to "/${robot}/image" when n = 1
    connect image to /slam when slam and n > 1
}
"""


def _robot(folder: Path, body: str) -> System:
    (folder / "arm.system").write_text(ARM, encoding="utf-8")
    text = f'system Robot imports import "camera.rnd" import "arm.system" {body}'
    return load_text(folder, text, camera=CAMERA)


def _camera(system: System) -> NodeInstance:
    (front,) = system.members
    assert isinstance(front, Subsystem)
    (camera,) = front.members
    assert isinstance(camera, NodeInstance)
    return camera


def _settings(node: NodeInstance) -> dict[str, object]:
    return {each.name: each.value for each in node.parameters}


def test_system_without_arguments_is_itself(tmp_path: Path) -> None:
    """There is nothing to compute, so nothing is copied: neither it nor a system that it uses."""
    plain = 'argument unused : int = 1 node c : camera parameters param label = "$${x} $y"'
    system = _robot(tmp_path, plain)
    assert resolve(system, {"unused": 5}) is system
    assert resolved(system) == (system, ())
    (tmp_path / "plain.system").write_text('system Plain imports import "camera.rnd"')
    outer = (
        'import "plain.system" argument a : int = 1 subsystem p : Plain topics topic /x when a = 1'
    )
    (part,) = resolve(_robot(tmp_path, outer)).members
    assert isinstance(part, Subsystem)
    (written,) = _robot(tmp_path, outer).members
    assert isinstance(written, Subsystem)
    assert part.system == written.system


def test_usual_values(tmp_path: Path) -> None:
    """Parts whose condition holds are there, with values in place of expressions."""
    system = resolve(_robot(tmp_path, ROBOT))
    assert not system.is_computed
    assert [each.name for each in system.topics] == ["/left/image", "/slam"]
    camera = _camera(system)
    assert camera.namespace == "cam1"
    assert _settings(camera) == {"rate": 4.0, "gains": (1.0, 2.5), "label": "left_1"}
    assert [each.target for each in camera.wirings] == ["/left/image"]


def test_given_values(tmp_path: Path) -> None:
    """What is not given stays usual; integers for doubles become doubles."""
    values: dict[str, Scalar] = {"n": 3, "speed": 1, "robot": "right"}
    system = resolve(_robot(tmp_path, ROBOT), values)
    assert [each.name for each in system.topics] == ["/right/image", "/slam"]
    camera = _camera(system)
    assert camera.namespace == "cam3"
    assert _settings(camera) == {"rate": 2.0, "gains": (3.0, 2.5), "count": 4, "label": "right_3"}
    assert isinstance(_settings(camera)["rate"], float)
    assert [each.target for each in camera.wirings] == ["/slam"]
    (front,) = resolve(_robot(tmp_path, ROBOT), {"slam": False}).members
    assert isinstance(front, Subsystem)
    assert front.members == ()


def test_places_are_kept(tmp_path: Path) -> None:
    """Findings about the resolved system point into the text as written."""
    written = _robot(tmp_path, ROBOT)
    system = resolve(written)
    assert system.source is written.source
    assert system.topics[0].name_span.text == '"/${robot}/image"'
    camera = _camera(system)
    assert camera.parameters[0].value_span.text == "$speed * 2"
    assert camera.wirings[0].target_span.text == '"/${robot}/image"'
    assert camera.namespace_span is not None
    assert camera.namespace_span.text == '"cam${n}"'


def test_nothing_is_left_to_compute(tmp_path: Path) -> None:
    """No part of it has a condition or an expression; what it is made of has all of them still."""
    written = _robot(tmp_path, ROBOT)
    again = resolve(resolve(written), {"n": 5})
    assert again == resolve(written)
    camera = _camera(again)
    assert (camera.when, camera.namespace_from) == (None, None)
    assert all(each.value_from is None and each.when is None for each in camera.parameters)
    assert all(each.target_from is None and each.when is None for each in camera.wirings)
    assert written.is_computed
    assert _camera(written).when is not None


NESTED = """\
argument v : double = 4
argument on : bool = true
subsystem l : Arm(rate = $v, name = "l") namespace /l
subsystem r : Arm(rate = $v * 2, seen = $on) namespace /r when v > 1
"""


def test_systems_get_what_is_passed_to_them(tmp_path: Path) -> None:
    """Each use has its own values; what is not passed has the default of the used system."""
    flat = flatten(resolve(_robot(tmp_path, NESTED)))
    assert {node.full_name: dict(node.parameters)["rate"] for node in flat.nodes} == {
        "/l/eye": 2.0,
        "/r/eye": 4.0,
    }
    assert [topic.name for topic in flat.topics] == ["/l/l_image", "/r/arm_image"]
    assert [dict(node.parameters)["label"] for node in flat.nodes] == ["l", "arm"]


def test_conditions_in_used_systems_follow_what_is_passed(tmp_path: Path) -> None:
    """One instance may lack what the other one has, or be absent as a whole."""
    system = _robot(tmp_path, NESTED)
    without = flatten(resolve(system, {"on": False}))
    assert [node.full_name for node in without.nodes] == ["/l/eye"]
    assert [topic.name for topic in without.topics] == ["/l/l_image", "/r/arm_image"]
    slow = flatten(resolve(system, {"v": 1}))
    assert [topic.name for topic in slow.topics] == ["/l/l_image"]


def test_flattening_takes_the_usual_values(tmp_path: Path) -> None:
    """Whoever asks for no values gets the system that starts without any."""
    system = _robot(tmp_path, NESTED)
    assert flatten(system) == flatten(resolve(system))


@pytest.mark.parametrize(
    ("body", "messages", "settings"),
    [
        ("param rate = 4 / $zero param count = 2", ["this divides by zero"], {"count": 2}),
        ("param gains = [1, $no] param count = 2", ["unknown argument 'no'"], {"count": 2}),
        ("param count = 3 when zero", ["'zero' is an integer, not a condition"], {}),
        ('param label = "${half}"', ["'half' is a double, of which several spellings exist"], {}),
        ("wirings connect image to $zero", ["a name is a text, and this is 0"], {}),
        (
            'param rate = $no param count = $text * 2 param label = "ok"',
            ["unknown argument 'no'", "this is a text, not a number"],
            {"label": "ok"},
        ),
    ],
)
def test_what_has_no_value_is_left_out(
    tmp_path: Path, body: str, messages: list[str], settings: dict[str, object]
) -> None:
    """All faults are collected, and the rest of the system is there."""
    declared = 'argument zero : int = 0 argument half : double = 0.5 argument text : string = "t"'
    body = body if body.startswith("wirings") else f"parameters {body}"
    system, faults = resolved(_robot(tmp_path, f"{declared} node c : camera {body}"))
    assert [each.message for each in faults] == messages
    (node,) = system.members
    assert isinstance(node, NodeInstance)
    assert _settings(node) == settings
    assert node.wirings == ()


def test_fault_in_what_is_passed(tmp_path: Path) -> None:
    """The used system has its default then, so that no other fault follows from it."""
    body = 'argument zero : int = 0 subsystem l : Arm(rate = 1 / $zero, name = "l")'
    system, faults = resolved(_robot(tmp_path, body))
    assert [(each.message, each.span.text) for each in faults] == [
        ("this divides by zero", "$zero")
    ]
    assert [dict(node.parameters)["label"] for node in flatten(system).nodes] == ["l"]


def test_system_that_uses_itself_is_resolved_once(tmp_path: Path) -> None:
    """The cycle is reported by the imports; resolving it ends."""
    path = tmp_path / "loop.system"
    path.write_text(
        'system Loop imports import "loop.system" argument a : bool = true\n'
        "subsystem inner : Loop(a = $a) when a\n"
    )
    model = Repository().load(path).model
    assert isinstance(model, System)
    assert len(resolve(model).members) == 1


@pytest.mark.parametrize(
    ("namespace", "name"),
    [("", "/front/eye"), ("near", "/front/near/eye"), ("/", "/eye"), ("/rear", "/rear/eye")],
)
def test_an_empty_namespace_adds_nothing(namespace: str, name: str, tmp_path: Path) -> None:
    """It leaves names where they are, and does not take them to the root."""
    text = (
        'argument inner : string = "" imports import "camera.rnd"'
        " subsystem outer namespace /front { subsystem part namespace $inner {"
        " node eye : camera } }"
    )
    system = load_text(tmp_path, f"system S {text}", camera=CAMERA)
    flat = flatten(resolve(system, {"inner": namespace}))
    assert [each.full_name for each in flat.nodes] == [name]
