"""Containers of a snapshot as models: what is loaded into them, and what a system cannot say."""

from __future__ import annotations

from pathlib import Path

from deros.importers.node_types import imported
from deros.importers.texts import files
from deros.live.snapshots import End, SeenNode, SeenParameter, Snapshot, Unseen
from deros.models.node import ParameterType, PortKind
from deros.systems.flatten import flatten
from tests.support.checks import checked
from tests.support.imported import import_into
from tests.support.systems import load

MAIN = SeenNode("/main", (), (), container=True, components=("/far/right", "/left", "/middle"))


def camera(name: str, image: str) -> SeenNode:
    """Return a camera that publishes something."""
    return SeenNode(name, (End(PortKind.PUBLISHER, image, "std_msgs/msg/Bool"),), ())


EYES = Snapshot(
    (
        camera("/alone", "/alone/image"),
        camera("/far/right", "/far/right/image"),
        camera("/left", "/left/image"),
        MAIN,
        camera("/middle", "/middle/image"),
    )
)


def test_golden_files() -> None:
    """Nodes in the namespace of their container stand in its braces, others say ``into``."""
    graph = imported(EYES, lambda _: True)
    assert graph.problems == ()
    texts = files(graph, "eyes")
    assert (
        texts["eyes.system"].body.partition("\n\n")[2]
        == """\
node alone : alone
wirings
  connect ~/image to /alone/image

container main {
  node left : right
  wirings
    connect ~/image to /left/image

  node middle : right
  wirings
    connect ~/image to /middle/image
}

subsystem far namespace /far {
  node right : right into /main
  wirings
    connect ~/image to /far/right/image
}
"""
    )
    assert (
        texts["nodes/right.rnd"].head
        == """\
// A running graph shows no package and no class: write the right ones here.
node right : unknown_package
plugin "unknown_package::Right"
"""
    )
    # One that is a process of its own has a program, and a type of its own.
    assert 'executable "alone"' in texts["nodes/alone.rnd"].head


def test_models_check_clean_and_say_who_is_where(tmp_path: Path) -> None:
    """Each node is in its container, by its full name."""
    import_into(tmp_path, EYES)
    system = tmp_path / "robot.system"
    assert checked(system) == []
    found = {each.full_name: each.container for each in flatten(load(system)).nodes}
    assert found == {
        "/alone": None,
        "/far/right": "/main",
        "/left": "/main",
        "/main": None,
        "/middle": "/main",
    }


def test_container_in_a_namespace_is_read_again(tmp_path: Path) -> None:
    """With a component in the root, which names it from there."""
    box = SeenNode("/far/box", (), (), container=True, components=("/far/right", "/left"))
    nodes = (box, camera("/far/right", "/x"), camera("/left", "/y"))
    import_into(tmp_path, Snapshot(nodes))
    system = tmp_path / "robot.system"
    assert checked(system) == []
    found = {each.full_name: each.container for each in flatten(load(system)).nodes}
    assert found == {"/far/box": None, "/far/right": "/far/box", "/left": "/far/box"}


def test_silent_container_is_a_node(tmp_path: Path) -> None:
    """What is in it is said to be unknown."""
    graph = import_into(tmp_path, Snapshot((SeenNode("/main", (), (), container=True),)))
    assert graph.problems == ("/main is a container: which nodes are in it is not known",)
    assert checked(tmp_path / "robot.system") == []


def test_container_with_ends_of_its_own_is_a_node(tmp_path: Path) -> None:
    """A system has no ends for a container: what is in it is said beside the models."""
    own = camera("/main", "/main/image")
    main = SeenNode("/main", own.ends, (), container=True, components=("/left",))
    graph = import_into(tmp_path, Snapshot((camera("/left", "/y"), main)))
    assert graph.problems == (
        "/main is a container with ends of its own, and in the model a node; in it there is /left",
    )
    assert checked(tmp_path / "robot.system") == []


def test_parameters_of_a_container_are_left_out(tmp_path: Path) -> None:
    """But for those of every node that are as usual."""
    values = {"thread_num": 4, "use_sim_time": False}
    kinds = {"thread_num": ParameterType.INTEGER, "use_sim_time": ParameterType.BOOL}
    parameters = tuple(SeenParameter(name, kinds[name], value) for name, value in values.items())
    main = SeenNode("/main", (), parameters, container=True, components=())
    graph = import_into(tmp_path, Snapshot((main,)))
    said = "/main: parameter thread_num is left out: a system sets none of a container"
    assert graph.problems == (said,)
    assert checked(tmp_path / "robot.system") == []


def test_container_without_parameter_services_lacks_nothing(tmp_path: Path) -> None:
    """Those of ROS 2 have none; one that is a node in the model is said to lack them."""
    silent = Unseen("/main has no parameter services: its parameters are not known", "/main", True)
    main = SeenNode("/main", container=True, components=("/left",))
    left = camera("/left", "/y")
    assert import_into(tmp_path, Snapshot((left, main), (silent,))).problems == ()
    assert checked(tmp_path / "robot.system") == []
    own = SeenNode("/main", left.ends, container=True, components=("/left",))
    assert silent.what in imported(Snapshot((left, own), (silent,)), lambda _: True).problems
