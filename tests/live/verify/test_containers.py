"""Nodes that are not in the container, or process, that the system says."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import pytest

from deros.interfaces.durations import NS_PER_S
from deros.live.snapshots import SeenNode, Snapshot, Unseen
from deros.live.verify.compare import compare
from deros.live.verify.expectation import Expectation, expectation
from deros.live.verify.graces import Graces
from deros.live.verify.texts import line
from deros.systems.flatten import flatten
from tests.support.seen import changed, graph_of, without
from tests.support.systems import load_text

CAMERA = 'node camera : vision\nplugin "vision::Camera"\nexecutable "camera"\n'
TEXT = """\
system Eyes
imports import "*.rnd"
container main {
  node left : camera
}
container other {
  node right : camera
}
node alone : camera
node guest : camera into /elsewhere
"""

ELSEWHERE = SeenNode("/elsewhere", container=True, components=("/guest",))


@pytest.fixture
def expected(tmp_path: Path) -> Expectation:
    """Give what the system says."""
    return expectation(flatten(load_text(tmp_path, TEXT, camera=CAMERA)), ignored=["/elsewhere"])


@pytest.fixture
def seen(tmp_path: Path) -> Snapshot:
    """Give its graph, as it is meant to be."""
    graph = graph_of(flatten(load_text(tmp_path, TEXT, camera=CAMERA)))
    return replace(graph, nodes=(*graph.nodes, ELSEWHERE))


def loaded(seen: Snapshot, container: str, *components: str) -> Snapshot:
    """Return a graph in which a container has other components."""
    return changed(seen, container, lambda node: replace(node, components=components))


def lines(expected: Expectation, seen: Snapshot) -> list[str]:
    """Return the differences without their places."""
    return [line(replace(each, span=None)) for each in compare(expected, seen).differences]


def test_system_as_it_is_meant_has_no_difference(expected: Expectation, seen: Snapshot) -> None:
    """Each node is where the system has it, in a container that it does not start as well."""
    assert lines(expected, seen) == []


def test_node_in_another_container_is_reported(expected: Expectation, seen: Snapshot) -> None:
    """With the place where the system says otherwise."""
    moved = loaded(loaded(seen, "/main"), "/other", "/left", "/right")
    assert lines(expected, moved) == ["wrong-container /left: /other in place of /main"]
    (found,) = compare(expected, moved).differences
    assert found.span is not None
    assert found.span.line == 4


def test_node_in_no_container_is_reported(expected: Expectation, seen: Snapshot) -> None:
    """It runs, and its container does not have it."""
    assert lines(expected, loaded(seen, "/main")) == [
        "wrong-container /left: a process of its own in place of /main"
    ]


def test_process_that_was_loaded_is_reported(expected: Expectation, seen: Snapshot) -> None:
    """A node that the system starts by itself is in a container."""
    assert lines(expected, loaded(seen, "/main", "/alone", "/left")) == [
        "wrong-container /alone: /main in place of a process of its own"
    ]


def test_node_in_two_containers_is_reported_for_neither(
    expected: Expectation, seen: Snapshot
) -> None:
    """Two nodes have the name: that is what is reported, and the right one is there."""
    two = loaded(seen, "/other", "/left", "/right")
    assert lines(expected, changed(two, "/left", lambda node: replace(node, count=2))) == [
        "repeated-node /left: 2 in place of 1; one that was killed counts until its lease ends, "
        "20 s with Fast DDS"
    ]


def test_missing_node_and_missing_container_are_reported_as_such(
    expected: Expectation, seen: Snapshot
) -> None:
    """Not a second time as a node in the wrong place."""
    assert lines(expected, without(seen, "/left")) == ["missing-node /left"]
    assert lines(expected, without(seen, "/main")) == ["missing-node /main"]
    assert lines(expected, without(seen, "/elsewhere")) == [
        "wrong-container /guest: a process of its own, as there is no /elsewhere in place of "
        "/elsewhere"
    ]


def test_silent_container_is_no_difference_and_no_end_of_one(
    expected: Expectation, seen: Snapshot
) -> None:
    """What was reported stays so, until the container says where the node is."""
    graces = Graces()
    silent = changed(seen, "/main", lambda node: replace(node, components=None))
    assert lines(expected, silent) == []
    away = compare(expected, loaded(seen, "/main"))
    late = 11 * NS_PER_S
    assert graces.look(0, away) == []
    (begun,) = graces.look(late, away)
    assert (begun.difference.node, begun.is_over) == ("/left", False)
    assert graces.look(late, compare(expected, silent)) == []
    (over,) = graces.look(late, compare(expected, seen))
    assert (over.difference.node, over.is_over) == ("/left", True)


def test_parameters_of_a_container_are_missed_only_where_some_are_meant(
    expected: Expectation, tmp_path_factory: pytest.TempPathFactory
) -> None:
    """A system has none for a container; one may be described as a node that has."""
    unseen = Unseen("/main has no parameter services", "/main", True)
    assert not expected.misses(unseen)
    assert expected.misses(unseen._replace(node="/left", is_of_container=False))
    assert not expected.misses(Unseen("/elsewhere has no parameter services", "/elsewhere", True))
    text = 'system S imports import "*.rnd" node main : manager parameters param thread_num = 4\n'
    manager = 'node manager : rclcpp_components executable "component_container_mt"\n'
    manager += "parameters name thread_num : integer\n"
    folder = tmp_path_factory.mktemp("other")
    described = expectation(flatten(load_text(folder, text, manager=manager)))
    assert described.misses(unseen)
