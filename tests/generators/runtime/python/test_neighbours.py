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
from deros.generators.runtime.python.deros_runtime.publishers import (
    PublisherCheck,
    unmatched_subscriptions,
)

RELIABLE = QoSProfile(depth=1, reliability=ReliabilityPolicy.RELIABLE)
BEST_EFFORT = QoSProfile(depth=1, reliability=ReliabilityPolicy.BEST_EFFORT)


def publisher(kind: str = "std_msgs/msg/Bool", qos: QoSProfile = RELIABLE) -> Any:
    """Return endpoint information of a publisher as given by the middleware."""
    return SimpleNamespace(
        node_name="driver", node_namespace="/arm", topic_type=kind, qos_profile=qos
    )


def subscribing(found: dict[str, list[Any]]) -> Mock:
    """Return a node that subscribes to topics, which have these publishers."""
    from std_msgs.msg import Bool

    def subscription(topic: str) -> SimpleNamespace:
        """Return one that is matched with the publishers that the middleware would match."""

        def matched() -> int:
            return found[topic].count(publisher())

        return SimpleNamespace(
            topic_name=topic, msg_type=Bool, qos_profile=RELIABLE, get_publisher_count=matched
        )

    node = Mock(subscriptions=[subscription(each) for each in found])
    node.count_publishers.side_effect = lambda topic: len(found[topic])
    node.get_publishers_info_by_topic.side_effect = lambda topic: [*found[topic]]
    return node


def report(*publishers: Any, shared: tuple[str, ...] = ()) -> tuple[str, str]:
    """Return the report about a topic with some publishers."""
    report_fault = Mock()
    PublisherCheck(subscribing({"/go": [*publishers]}), report_fault, shared).check()
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
    found: dict[str, list[Any]] = {each: [publisher()] for each in ("/go", "/a", "/b")}
    node = subscribing(found)
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


def test_details_are_asked_for_only_where_something_may_be_wrong() -> None:
    """One publisher that is matched is known by two counts."""
    found = {"/go": [publisher()]}
    node = subscribing(found)
    check = PublisherCheck(node, Mock())
    check.check()
    node.get_publishers_info_by_topic.assert_not_called()
    for each in ([publisher(qos=BEST_EFFORT)], [publisher("std_msgs/msg/String")]):
        node.get_publishers_info_by_topic.reset_mock()
        found["/go"] = each
        check.check()
        node.get_publishers_info_by_topic.assert_called_once_with("/go")


def test_subscription_that_gets_nothing_is_found_by_the_number_of_those_that_do() -> None:
    """Of the ends of a topic, only details tell which does not match, and why."""
    own = publisher()
    node = Mock(publishers=[SimpleNamespace(topic_name="/go", get_subscription_count=lambda: 1)])
    node.get_fully_qualified_name.return_value = "/arm/driver"
    node.count_subscribers.return_value = 1
    assert unmatched_subscriptions(node, "/go") == ""
    node.get_publishers_info_by_topic.assert_not_called()
    reader = SimpleNamespace(**{**vars(publisher("std_msgs/msg/String")), "node_name": "panel"})
    node.count_subscribers.return_value = 2
    node.get_publishers_info_by_topic.return_value = [own]
    node.get_subscriptions_info_by_topic.return_value = [own, reader]
    assert unmatched_subscriptions(node, "/go") == (
        "/arm/panel subscribes to std_msgs/msg/String on it, which is not published"
    )


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
    node, found = Mock(publishers=[]), Mock()
    node.count_subscribers.return_value = 0
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
    node, found = Mock(publishers=[]), Mock()
    node.count_subscribers.return_value = 0
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
