"""Publishers with another type or incompatible QoS, duplicates, and nodes of the same name."""

from __future__ import annotations

from types import SimpleNamespace
from typing import Any
from unittest.mock import Mock

import pytest

pytest.importorskip("rclpy")
from rclpy.qos import QoSProfile, ReliabilityPolicy

from deros.generators.runtime.python.deros_runtime.duplicate_instance import (
    DuplicateInstanceDetector,
)
from deros.generators.runtime.python.deros_runtime.instance import Refusal
from deros.generators.runtime.python.deros_runtime.publishers import PublisherCheck

RELIABLE = QoSProfile(depth=1, reliability=ReliabilityPolicy.RELIABLE)
BEST_EFFORT = QoSProfile(depth=1, reliability=ReliabilityPolicy.BEST_EFFORT)


def publisher(kind: str = "std_msgs/msg/Bool", qos: QoSProfile = RELIABLE) -> Any:
    """Return endpoint information of a publisher as given by the middleware."""
    return SimpleNamespace(
        node_name="driver", node_namespace="/arm", topic_type=kind, qos_profile=qos
    )


def report(*publishers: Any, shared: tuple[str, ...] = ()) -> tuple[str, str]:
    """Return the report about a topic with some publishers."""
    from std_msgs.msg import Bool

    subscription = SimpleNamespace(topic_name="/go", msg_type=Bool, qos_profile=RELIABLE)
    node = Mock(subscriptions=[subscription])
    node.get_publishers_info_by_topic.return_value = list(publishers)
    report_fault = Mock()
    PublisherCheck(node, report_fault, shared).check()
    topic, text = report_fault.call_args.args
    return topic, text


def test_matching_publisher_is_not_a_fault() -> None:
    """Nor is a topic without publishers."""
    assert report(publisher()) == ("/go", "")
    assert report() == ("/go", "")


def test_other_type_and_incompatible_qos_are_faults() -> None:
    """Each publisher is named with its node."""
    _, text = report(publisher("std_msgs/msg/String"), publisher(qos=BEST_EFFORT), publisher())
    first, second = text.split("; ", 1)
    assert first == "/arm/driver publishes std_msgs/msg/String on it, which is not received"
    assert second.startswith("/arm/driver offers an incompatible QoS on it:")


def test_second_publisher_is_a_fault_unless_the_topic_is_shared() -> None:
    """Only matching publishers count, including those of nodes not known yet."""
    unnamed = publisher()
    unnamed.node_name = "_NODE_NAME_UNKNOWN_"
    _, text = report(publisher(), publisher("std_msgs/msg/String"), unnamed)
    assert text.endswith(
        "; 2 publishers where one is expected: /arm/driver, a node that is not known yet"
    )
    assert report(publisher(), publisher(), shared=("/go",)) == ("/go", "")


def test_topic_that_must_not_have_several_publishers_is_checked_each_time() -> None:
    """Others take turns. Its name is kept while it has several, also where that is no fault."""
    from std_msgs.msg import Bool

    names = ("/go", "/a", "/b")
    node = Mock(
        subscriptions=[
            SimpleNamespace(topic_name=each, msg_type=Bool, qos_profile=RELIABLE) for each in names
        ]
    )
    found: dict[str, list[Any]] = {each: [publisher()] for each in names}
    node.get_publishers_info_by_topic.side_effect = found.__getitem__
    report_fault = Mock()
    check = PublisherCheck(node, report_fault, shared=("/go",), alone=("/go",))
    for _ in range(3):
        check.check()
    checked = [call.args[0] for call in report_fault.call_args_list]
    assert checked == ["/go", "/a", "/go", "/b", "/go", "/a"]
    assert check.crowded == set()
    found["/go"] = [publisher(), publisher(), publisher("std_msgs/msg/String")]
    check.check()
    assert check.crowded == {"/go"}
    found["/go"] = [publisher(), publisher("std_msgs/msg/String")]
    check.check()
    assert check.crowded == set()


def test_name_that_stands_twice_is_explained() -> None:
    """A killed node stays in the graph beside the one that was started in its place."""
    _, text = report(publisher(), publisher())
    assert text == (
        "2 publishers where one is expected: /arm/driver, /arm/driver (one that died counts until"
        " the middleware forgets it: 20 s with Fast DDS)"
    )
    unnamed = publisher()
    unnamed.node_name = "_NODE_NAME_UNKNOWN_"
    assert "died" not in report(unnamed, unnamed)[1]


def test_node_without_subscriptions_checks_nothing() -> None:
    """The check does not fail."""
    PublisherCheck(Mock(subscriptions=[]), Mock(side_effect=AssertionError)).check()


def _reports(found: Mock, topic: str) -> list[str]:
    """Return the report about a topic."""
    return [call.args[1] for call in found.call_args_list if call.args[0] == topic]


def test_second_heartbeat_is_reported_and_ends_the_later_node() -> None:
    """It is a fault until it is known which of the two started later."""
    node, found = Mock(), Mock()
    node.get_publishers_info_by_topic.return_value = []  # no reader is known either
    node.count_publishers.return_value = 2
    detector = DuplicateInstanceDetector(node, "/safety/heartbeat", [], found, int)
    detector._order = Mock()
    detector._order.gives_way.return_value = False
    detector.check()
    assert detector._order.gives_way.call_args.args[0]
    assert _reports(found, "/safety/heartbeat")[-1].startswith(
        "another node publishes this heartbeat"
    )
    detector._order.gives_way.return_value = True
    with pytest.raises(Refusal, match="this one started last"):
        detector.check()
    detector._order.gives_way.return_value = False
    node.count_publishers.return_value = 1
    detector.check()
    assert not detector._order.gives_way.call_args.args[0]
    assert _reports(found, "/safety/heartbeat")[-1] == ""


def test_other_publisher_of_a_state_is_named() -> None:
    """One topic is checked at a time, and the node itself does not count."""
    node, found = Mock(), Mock()
    node.get_subscriptions_info_by_topic.return_value = []
    counts = {"/safety/heartbeat": 1, "/stop": 2, "/slow": 1}
    node.count_publishers = counts.__getitem__
    node.get_fully_qualified_name.return_value = "/safety"
    own = SimpleNamespace(node_name="safety", node_namespace="/")
    node.get_publishers_info_by_topic.return_value = [own, publisher()]
    detector = DuplicateInstanceDetector(node, "/safety/heartbeat", ["/stop", "/slow"], found, int)
    for _ in range(3):
        detector.check()
    text = "published by /arm/driver, too: its subscribers cannot tell them apart"
    assert _reports(found, "/stop") == [text, text]
    assert _reports(found, "/slow") == [""]
