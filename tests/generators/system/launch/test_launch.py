"""The launch file, held against the interface of ``launch`` and ``launch_ros``."""

from __future__ import annotations

import sys
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from types import ModuleType
from typing import Any

import pytest

from deros.generators.builtin import rossystem_launch
from deros.generators.output.writer import write
from deros.generators.system.view import NodeView, system_view
from deros.metamodels.system import System
from tests.support.golden import Golden
from tests.support.lint import assert_lint_clean
from tests.support.systems import CONTEXT, EVERYTHING, load, load_text

Parameters = dict[str, bool | int | float | str | list[Any]]


@dataclass(frozen=True, kw_only=True)
class Node:
    """Takes what ``launch_ros.actions.Node`` of Jazzy takes and is used here, and nothing else."""

    package: str
    executable: str
    name: str
    namespace: str
    output: str
    parameters: Sequence[Parameters] = ()
    remappings: Sequence[tuple[str, str]] = ()
    ros_arguments: Sequence[str] = ()
    respawn: bool = False
    respawn_delay: float | None = None
    respawn_max_retries: int = -1


class LifecycleNode(Node):
    """A node that is managed."""


@dataclass(frozen=True)
class LaunchDescription:
    """What ``launch`` makes of a list of actions."""

    entities: list[Node]


@pytest.fixture
def launch(monkeypatch: pytest.MonkeyPatch) -> None:
    """Put a strict stand-in in the place of ``launch`` and ``launch_ros``."""
    modules: dict[str, list[type]] = {
        "launch": [LaunchDescription],
        "launch_ros": [],
        "launch_ros.actions": [Node, LifecycleNode],
    }
    for name, members in modules.items():
        module = ModuleType(name)
        for member in members:
            setattr(module, member.__name__, member)
        monkeypatch.setitem(sys.modules, name, module)


def actions(system: System) -> list[Node]:
    """Run the launch file of a system and return its actions."""
    ((path, file),) = rossystem_launch(system, CONTEXT).items()
    names: dict[str, Any] = {}
    exec(compile(file.text, path, "exec"), names)
    description: LaunchDescription = names["generate_launch_description"]()
    return description.entities


def as_action(node: NodeView) -> Node:
    """Return the action that a node ought to have."""
    listed = {
        name: list(value) if isinstance(value, tuple) else value for name, value in node.parameters
    }
    level = f"{node.logger}:={node.log_level}"
    return (LifecycleNode if node.lifecycle else Node)(
        package=node.package,
        executable=node.executable,
        name=node.name,
        namespace=node.namespace,
        output="screen",
        parameters=[listed] if listed else (),
        remappings=list(node.remappings) or (),
        ros_arguments=["--log-level", level] if node.log_level else (),
        respawn=node.respawn_delay is not None,
        respawn_delay=node.respawn_delay,
        respawn_max_retries=-1 if node.respawn_max is None else node.respawn_max,
    )


def test_the_launch_file_is_as_kept(golden: Golden) -> None:
    """The text for a system that uses everything is the golden one."""
    golden.check("rossystem_launch", rossystem_launch(load(EVERYTHING), CONTEXT))


@pytest.mark.usefixtures("launch")
def test_every_node_is_an_action_with_all_that_the_system_says() -> None:
    """The actions are those of the model, in its order, and take only known arguments."""
    system = load(EVERYTHING)
    assert actions(system) == [as_action(node) for node in system_view(system).nodes]


@pytest.mark.usefixtures("launch")
def test_doubles_stay_doubles_and_texts_texts() -> None:
    """What looks like a number, a truth value or nothing in YAML is still a text."""
    eye = actions(load(EVERYTHING))[0]
    assert repr(eye.parameters[0]["exposure"]) == "1.0"
    assert eye.parameters[0]["lens"] == "on"
    assert eye.parameters[0]["labels"] == ["yes", "12", "", "it is ünicode ☃"]


@pytest.mark.usefixtures("launch")
def test_an_empty_system_has_a_launch_file(tmp_path: Path) -> None:
    """Nothing to start is no reason to fail, or to import what is not used."""
    system = load_text(tmp_path, "system Empty")
    assert actions(system) == []
    write(rossystem_launch(system, CONTEXT), tmp_path / "out")
    assert_lint_clean(tmp_path / "out")


def test_the_launch_file_passes_aments_linters(tmp_path: Path) -> None:
    """flake8 and pep257 as ament sets them have nothing to say, names of any length included."""
    write(rossystem_launch(load(EVERYTHING), CONTEXT), tmp_path)
    long = "n" * 200
    system = load_text(
        tmp_path,
        f'system {long} "say \\"\\"\\" and # this" imports import "*.rnd" subsystem {long} '
        f'"{"very " * 40}long" {{ node {long} : {long} parameters param {long} = "{long}" '
        f"wirings connect {long} to /{long} }}",
        **{
            long: f'node {long} : p{long} parameters name {long} : string = "" '
            f"publishes topic {long} : std_msgs.Bool"
        },
    )
    write(rossystem_launch(system, CONTEXT), tmp_path)
    assert_lint_clean(tmp_path)


def test_the_real_launch_reads_it() -> None:
    """Where ``launch_ros`` is installed, it makes the same nodes of the file."""
    actual = pytest.importorskip("launch_ros.actions")
    system = load(EVERYTHING)
    found = actions(system)
    assert all(isinstance(action, actual.Node) for action in found)
    assert len(found) == len(list(system_view(system).nodes))
