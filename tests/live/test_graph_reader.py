"""Reading a graph again: what has changed is read, what has not is kept."""

from __future__ import annotations

import ctypes
import time
from collections.abc import Callable, Iterator

import pytest

from deros.live.graph_reader import GraphReader
from deros.live.inquiries import Inquiry
from deros.live.looks import snapshot
from deros.live.observer import Observer
from deros.models.node import PortKind
from tests.support.ros import LIMIT, Peer


@pytest.fixture
def observer(ros_env: dict[str, str], ros_peer: Peer) -> Iterator[Observer]:
    """Give an observer in the domain of the test, started after the peer."""
    del ros_peer
    with Observer(int(ros_env["ROS_DOMAIN_ID"])) as found:
        yield found


def until_changed(observer: Observer, change: Callable[[], object]) -> None:
    """Make a change of the graph, and wait until it is counted."""
    before = observer.graph_version
    change()
    assert observer.until(lambda: observer.graph_version != before, time.monotonic() + LIMIT)


def shows_all(observer: Observer, *peers: Peer) -> bool:
    """Return whether the observer is shown all ends that nodes have, which are found one by one."""
    return all(
        getattr(observer.node, read)(peer.node.get_name(), peer.node.get_namespace())
        == getattr(peer.node, read)(peer.node.get_name(), peer.node.get_namespace())
        for peer in peers
        for read in (
            "get_publisher_names_and_types_by_node",
            "get_subscriber_names_and_types_by_node",
            "get_service_names_and_types_by_node",
            "get_client_names_and_types_by_node",
        )
    )


def ends(reader: GraphReader, *, afresh: bool = False) -> dict[str, str | None]:
    """Return the topics of the peer with the reliability of its ends."""
    return {
        end.name: None if end.qos is None else end.qos.reliability
        for node in reader.whole(afresh=afresh).nodes
        for end in node.ends
        if node.full_name == "/test_peer" and end.kind is PortKind.PUBLISHER
    }


@pytest.mark.ros
def test_each_change_of_the_graph_is_counted(
    ros_env: dict[str, str], observer: Observer, ros_peer: Peer
) -> None:
    """An end that comes, one of another QoS in its place, a node; and of the observer itself."""
    from rclpy.qos import qos_profile_sensor_data
    from std_msgs.msg import Bool

    snapshot(observer, timeout=LIMIT)
    assert observer.graph_version == observer.graph_version
    node = ros_peer.node
    until_changed(observer, lambda: node.create_publisher(Bool, "/x", 1))
    until_changed(observer, lambda: node.destroy_publisher(next(iter(node.publishers))))
    until_changed(observer, lambda: node.create_publisher(Bool, "/x", qos_profile_sensor_data))
    peers: list[Peer] = []
    until_changed(observer, lambda: peers.append(Peer(int(ros_env["ROS_DOMAIN_ID"]), "joker")))
    until_changed(observer, peers[0].close)
    until_changed(observer, lambda: observer.node.create_publisher(Bool, "/own", 1))


@pytest.mark.ros
def test_graph_is_read_at_each_look_where_rcl_cannot_be_called(
    ros_env: dict[str, str], ros_peer: Peer, monkeypatch: pytest.MonkeyPatch
) -> None:
    """It may have changed each time, and is seen as it is."""
    from std_msgs.msg import Bool

    def refused(name: str) -> None:
        raise OSError(name)

    monkeypatch.setattr(ctypes, "CDLL", refused)
    ros_peer.node.create_publisher(Bool, "/x", 1)
    with Observer(int(ros_env["ROS_DOMAIN_ID"])) as observer:
        assert observer.graph_version != observer.graph_version
        (node,) = snapshot(observer, timeout=LIMIT).nodes
    assert [end.name for end in node.ends] == ["/x"]


@pytest.mark.ros
def test_only_what_has_changed_is_read_again(
    observer: Observer, ros_peer: Peer, monkeypatch: pytest.MonkeyPatch
) -> None:
    """The QoS of topics whose ends changed; all of it if it is wanted afresh."""
    from rclpy.qos import qos_profile_sensor_data
    from std_msgs.msg import Bool

    other = Peer(ros_peer.node.context.get_domain_id(), "other")
    try:
        node = ros_peer.node
        first = node.create_publisher(Bool, "/a", 1)
        other.node.create_publisher(Bool, "/b", 1)
        reader = GraphReader(observer)
        deadline = time.monotonic() + LIMIT
        observer.until(lambda: len(reader.names().nodes) == 2, deadline)
        observer.until(lambda: shows_all(observer, ros_peer, other), deadline)
        observer.until(lambda: reader.whole(afresh=False).complete, deadline)
        read: list[str] = []
        info = observer.node.get_publishers_info_by_topic

        def counted(topic: str) -> object:
            read.append(topic)
            return info(topic)

        monkeypatch.setattr(observer.node, "get_publishers_info_by_topic", counted)
        before = reader.names()
        assert reader.names() == before
        assert all(a is b for a, b in zip(before.nodes, reader.names().nodes, strict=True))
        assert ends(reader) == {"/a": "reliable"}
        assert read == []
        until_changed(observer, lambda: node.create_publisher(Bool, "/c", 1))
        observer.until(lambda: ends(reader) == {"/a": "reliable", "/c": "reliable"}, deadline)
        assert "/b" not in read
        assert {"/a", "/c"} <= {*read}
        # Within one look, another end takes the place of the first: names do not show that.
        observer.until(lambda: reader.whole(afresh=False).complete, deadline)
        until_changed(observer, lambda: node.create_publisher(Bool, "/a", qos_profile_sensor_data))
        until_changed(observer, lambda: node.destroy_publisher(first))
        observer.until(
            lambda: ends(reader, afresh=True) == {"/a": "best_effort", "/c": "reliable"}, deadline
        )
        assert ends(reader) == {"/a": "best_effort", "/c": "reliable"}
    finally:
        other.close()


@pytest.mark.ros
def test_node_without_the_parameters_that_were_known_says_so(
    observer: Observer, ros_peer: Peer
) -> None:
    """It answers a question for the values of some with nothing, as rclcpp does."""
    from rcl_interfaces.srv import GetParameters, ListParameters

    node = ros_peer.node
    node.create_service(GetParameters, "~/get_parameters", lambda _, response: response)
    node.create_service(ListParameters, "~/list_parameters", lambda _, response: response)
    reader = GraphReader(observer)
    deadline = time.monotonic() + LIMIT

    def is_offered() -> bool:
        nodes = reader.names().nodes
        return bool(nodes) and len(nodes[0].services) == 2

    assert observer.until(is_offered, deadline)
    (asked,) = reader.names().nodes
    known = Inquiry(observer.node, asked, described=False, names=["rate"])
    anew = Inquiry(observer.node, asked, described=False)
    try:
        ros_peer.until(lambda: _step(observer, known, anew))
        assert known.has_other_names()
        assert known.parameters() is None
        assert not anew.has_other_names()
        assert anew.parameters() == ()
    finally:
        known.close()
        anew.close()


def _step(observer: Observer, *inquiries: Inquiry) -> bool:
    """Let the observer take what has come; return whether all is answered."""
    observer.wait(0.01)
    waiting = [each for each in inquiries if not each.is_done()]
    return not waiting
