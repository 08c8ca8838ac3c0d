"""Snapshots of running graphs: when they are taken, and what is said of what cannot be seen."""

from __future__ import annotations

import contextlib
import sys
import time
from collections.abc import Iterator
from pathlib import Path

import pytest

from deros.importers.node_types import imported
from deros.live import looks
from deros.live.looks import UnsteadyGraphError, snapshot
from deros.live.observer import Observer
from deros.live.snapshots import Unseen
from deros.models.node import PortKind
from tests.support.ros import LIMIT, Peer, read_line, running

PROGRAM = str(Path(__file__).resolve().parent.parent / "support" / "graph_program.py")


@pytest.fixture
def observer(ros_env: dict[str, str], ros_peer: Peer) -> Iterator[Observer]:
    """Give an observer in the domain of the test, and start it after the peer."""
    del ros_peer
    with Observer(int(ros_env["ROS_DOMAIN_ID"])) as found:
        yield found


@pytest.mark.ros
def test_observer_is_not_seen_and_leaves_nothing(ros_env: dict[str, str], ros_peer: Peer) -> None:
    """Neither its node nor the clients by which it asks are there when it has gone."""
    del ros_peer
    domain = int(ros_env["ROS_DOMAIN_ID"])
    with running([sys.executable, PROGRAM, "left"], ros_env) as program:
        assert read_line(program) == "up\n"
        with Observer(domain) as first:
            seen = snapshot(first, timeout=LIMIT)
            clients = first.node.get_client_names_and_types_by_node(first.node.get_name(), "/")
            assert clients == []
            name = first.node.get_name()
        peer = Peer(domain, "onlooker")
        try:
            peer.until(lambda: "lidar" in peer.node.get_node_names())
            peer.until(lambda: name not in peer.node.get_node_names())
        finally:
            peer.close()
    assert [node.full_name for node in seen.nodes] == ["/left/lidar", "/test_peer"]


@pytest.mark.ros
def test_graph_that_keeps_changing_is_refused(
    observer: Observer, ros_peer: Peer, monkeypatch: pytest.MonkeyPatch
) -> None:
    """The topics that come and go are named."""
    publishers: list[object] = []
    spin = observer._executor.spin_once

    def changing(timeout_sec: float | None) -> None:
        from std_msgs.msg import Bool

        publishers.append(ros_peer.node.create_publisher(Bool, f"/t{len(publishers)}", 1))
        spin(timeout_sec=timeout_sec)

    monkeypatch.setattr(observer._executor, "spin_once", changing)
    with pytest.raises(UnsteadyGraphError, match=r"within 2 s: .*/t\d+ of /test_peer"):
        snapshot(observer, timeout=2, equal=5, quiet=0)


@pytest.mark.ros
def test_one_more_look_follows_each_change(
    observer: Observer, ros_peer: Peer, monkeypatch: pytest.MonkeyPatch
) -> None:
    """An end that comes shortly before the last look is seen."""
    from std_msgs.msg import Bool

    looks = 0
    spin = observer._executor.spin_once

    def late(timeout_sec: float | None) -> None:
        nonlocal looks
        looks += 1
        if looks == 8:
            ros_peer.node.create_subscription(Bool, "/late", lambda _: None, 1)
        spin(timeout_sec=timeout_sec)

    monkeypatch.setattr(observer._executor, "spin_once", late)
    (node,) = snapshot(observer, timeout=LIMIT, equal=50, quiet=0).nodes
    assert [(end.kind, end.name) for end in node.ends] == [(PortKind.SUBSCRIPTION, "/late")]


@pytest.mark.ros
def test_node_that_hangs_is_named(ros_env: dict[str, str], observer: Observer) -> None:
    """Its ends are known, its parameters and its state are not."""
    from tests.support.processes import freeze, thaw

    with running([sys.executable, PROGRAM, "crane"], ros_env) as program:
        assert read_line(program) == "up\n"
        observer.until(lambda: "crane" in observer.node.get_node_names(), time.monotonic() + LIMIT)
        freeze(program.pid)
        try:
            seen = snapshot(observer, "/crane", timeout=LIMIT)
        finally:
            thaw(program.pid)
    (crane,) = seen.nodes
    assert (crane.parameters, crane.lifecycle) == (None, "unknown")
    assert [end.name for end in crane.ends] == ["/crane/load"]
    questions = "list_parameters, get_parameters, describe_parameters"
    said = f"/crane did not answer within 5 s: {questions}, get_state"
    assert seen.unseen == (Unseen(said, "/crane"),)


@pytest.mark.ros
def test_nodes_that_hang_do_not_keep_others_from_being_asked(
    ros_env: dict[str, str], observer: Observer, monkeypatch: pytest.MonkeyPatch
) -> None:
    """More of them than may be late: the next are asked when their time is over."""
    from tests.support.processes import freeze, thaw

    monkeypatch.setattr(looks, "AT_ONCE", 2)
    monkeypatch.setattr(looks, "LATE", 1)
    monkeypatch.setattr(looks, "ANSWER_S", 1.0)
    names = ["/crane", "/left/lidar", "/right/lidar"]
    with contextlib.ExitStack() as stack:
        programs = []
        for name in names:
            command = [sys.executable, PROGRAM, name.split("/")[1]]  # "left" of "/left/lidar"
            programs.append(stack.enter_context(running(command, ros_env)))
        assert {read_line(each) for each in programs} == {"up\n"}
        observer.settled(lambda: len(observer.node.get_node_names()), time.monotonic() + LIMIT)
        for each in programs[:2]:
            freeze(each.pid)
            stack.callback(thaw, each.pid)
        found = snapshot(observer, timeout=LIMIT)
    seen = {each.full_name: each for each in found.nodes}
    assert [name for name in names if seen[name].parameters is None] == names[:2]
    silent = [each.node for each in found.unseen if "did not answer" in each.what]
    assert silent == names[:2]


@pytest.mark.ros
def test_ends_that_have_no_single_answer_are_named(observer: Observer, ros_peer: Peer) -> None:
    """Two kinds of QoS, and two nodes of one name."""
    from rclpy.qos import qos_profile_sensor_data
    from std_msgs.msg import Bool

    ros_peer.node.create_publisher(Bool, "/x", 1)
    ros_peer.node.create_publisher(Bool, "/x", qos_profile_sensor_data)
    twin = Peer(ros_peer.node.context.get_domain_id(), "test_peer")
    try:
        seen = snapshot(observer, timeout=LIMIT)
    finally:
        twin.close()
    (node,) = seen.nodes
    assert node.count == 2
    assert {(each.node, each.what) for each in seen.unseen} == {
        ("/test_peer", "/test_peer has publisher /x with 2 kinds of QoS"),
        ("/test_peer", "/test_peer has no parameter services: its parameters are not known"),
    }
    assert set(imported(seen, lambda _: True).problems) == {
        "2 nodes are called /test_peer: they are seen as one",
        "/test_peer has publisher /x with 2 kinds of QoS",
        "/test_peer has no parameter services: its parameters are not known",
    }
