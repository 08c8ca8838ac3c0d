"""Ports that share a name: the remapping rules they need, and wirings that no rule can express."""

from __future__ import annotations

from pathlib import Path

import pytest

from deros import codes
from deros.generators.system.view import ACTION_PARTS, system_view
from deros.models.node import PortKind
from deros.systems.flat import FlatNode
from deros.systems.flatten import flatten
from deros.systems.remapping import wired_apart
from tests.support.systems import load_text

SLAM = """
    node slam : mapping
    parameters
      name map_topic : string = "map"
    publishes
      topic map : nav_msgs.OccupancyGrid
      topic tiles : nav_msgs.OccupancyGrid via map_topic
    subscribes
      topic map : nav_msgs.OccupancyGrid
    services
      service map : nav_msgs.GetMap
    clients
      client map : nav_msgs.GetMap
      client dock : std_srvs.Trigger
    actions
      action dock : nav2_msgs.NavigateToPose
    action_clients
      action dock : nav2_msgs.NavigateToPose
"""


def node(folder: Path, wirings: str, head: str = "slam : slam") -> FlatNode:
    """Flatten a system of one node with the given wiring."""
    text = f'system Test imports import "*.rnd" node {head} wirings {wirings}'
    (only,) = flatten(load_text(folder, text, slam=SLAM)).nodes
    return only


def names(flat: FlatNode) -> dict[tuple[PortKind, str], str]:
    """Return the topic of each port."""
    return {(port.port.kind, port.port.name): port.topic for port in flat.ports}


def refused(flat: FlatNode) -> list[str]:
    """Return the findings, all of which must be DRS120."""
    findings = list(wired_apart(flat))
    assert {each.code for each in findings} <= {codes.WIRED_APART}
    return [each.message for each in findings]


def test_plain_name_applies_to_ports_of_all_kinds(tmp_path: Path) -> None:
    """Publisher, subscription, service and client move together, by one rule."""
    flat = node(tmp_path, "connect map to /world connect tiles to /tiles")
    ends = names(flat)
    kinds = (PortKind.PUBLISHER, PortKind.SUBSCRIPTION, PortKind.SERVICE, PortKind.CLIENT)
    assert [ends[kind, "map"] for kind in kinds] == ["/world"] * 4
    assert flat.remappings == (("map", "/world"),)
    assert refused(flat) == []


def test_topics_and_services_of_one_name_are_remapped_separately(tmp_path: Path) -> None:
    """Rules for topics alone and services alone are used where necessary."""
    flat = node(
        tmp_path,
        "connect publisher map to /world connect subscriber map to /world"
        " connect service map to /get connect client map to /get connect tiles to /tiles",
    )
    assert flat.remappings == (("rostopic://map", "/world"), ("rosservice://map", "/get"))
    assert refused(flat) == []


def test_unwired_service_is_not_remapped_with_its_topic(tmp_path: Path) -> None:
    """A rule without a scheme would remap it too."""
    flat = node(
        tmp_path,
        "connect publisher map to /world connect subscriber map to /world connect tiles to /tiles",
    )
    assert flat.remappings == (("rostopic://map", "/world"),)
    assert names(flat)[PortKind.SERVICE, "map"] == "/map"


@pytest.mark.parametrize(
    ("wirings", "message"),
    [
        (
            "connect publisher map to /a connect subscriber map to /b connect tiles to /t",
            "publisher 'map' and subscriber 'map' of 'slam' cannot be on '/a' and '/b'",
        ),
        (
            "connect publisher map to /a connect tiles to /t",
            "publisher 'map' and subscriber 'map' of 'slam' cannot be on '/a' and '/map'",
        ),
        (
            "connect service map to /a connect client map to /b",
            "service 'map' and client 'map' of 'slam' cannot be on '/a' and '/b'",
        ),
        (
            "connect map to /a",  # the default of the parameter is the same name
            "publisher 'map' and publisher 'tiles' of 'slam' cannot be on '/a' and '/map'",
        ),
        (
            "connect action dock to /a connect action_client dock to /b",
            "action 'dock' and action_client 'dock' of 'slam' cannot be on '/a' and '/b'",
        ),
        (
            "connect map to /a connect tiles to /map",  # the parameter has a remapped name
            "publisher 'map' and publisher 'tiles' of 'slam' cannot be on '/a' and '/map'",
        ),
    ],
)
def test_wirings_that_no_rule_can_separate_are_reported(
    tmp_path: Path, wirings: str, message: str
) -> None:
    """Two ends of one name, wired or not, cannot be on two topics."""
    messages = refused(node(tmp_path, wirings))
    assert len(messages) == 1
    assert messages[0].startswith(message)


def test_names_are_compared_after_resolution(tmp_path: Path) -> None:
    """``map`` and ``/map`` are the same name only in the root namespace."""
    other = SLAM.replace("topic map : nav_msgs.OccupancyGrid\n    services", "topic /map"
                         " : nav_msgs.OccupancyGrid\n    services")  # fmt: skip
    text = 'system Test imports import "*.rnd" node slam : slam NS wirings connect tiles to /t'
    text += " connect publisher map to /a"
    for namespace, expected in (("", 1), ("namespace /x", 0)):
        system = load_text(tmp_path, text.replace("NS", namespace), slam=other)
        assert len(refused(flatten(system).nodes[0])) == expected


def test_two_wirings_through_one_parameter_are_an_error(tmp_path: Path) -> None:
    """The second wiring would have no effect."""
    two = SLAM.replace("topic map : nav_msgs.OccupancyGrid\n    services", "topic seen"
                       " : nav_msgs.OccupancyGrid via map_topic\n    services")  # fmt: skip
    text = 'system Test imports import "*.rnd" node slam : slam wirings connect tiles to /t'
    system = load_text(tmp_path, f"{text} connect seen to /u", slam=two)
    (message,) = refused(flatten(system).nodes[0])
    assert message.startswith("'seen' and 'tiles' of 'slam' both take their names from parameter")


def test_action_and_service_of_one_name_are_remapped_separately(tmp_path: Path) -> None:
    """The rule of the action is for topics; its parts keep their own names."""
    wirings = (
        "connect action dock to /a connect action_client dock to /a connect client dock to /b"
        " connect map to /map connect tiles to /t"
    )
    text = f'system Test imports import "*.rnd" node slam : slam wirings {wirings}'
    (view,) = system_view(load_text(tmp_path, text, slam=SLAM)).nodes
    parts = [(f"dock/_action/{part}", f"/a/_action/{part}") for part in ACTION_PARTS]
    assert sorted(view.remappings) == sorted(
        [("rostopic://dock", "/a"), *parts, ("rosservice://dock", "/b")]
    )
