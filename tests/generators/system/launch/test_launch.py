"""The launch file, checked against the interface of ``launch`` and ``launch_ros``."""

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
from deros.generators.system.launch.relative import relative
from deros.generators.system.view import NodeView, system_view
from deros.models.system import System
from deros.names.graph_names import ANY_ROOT
from tests.support.golden import Golden
from tests.support.lint import assert_lint_clean
from tests.support.systems import CONTEXT, EVERYTHING, load, load_text

Parameters = dict[str, bool | int | float | str | list[Any]]


@dataclass(frozen=True, kw_only=True)
class Node:
    """Accepts exactly the used arguments of ``launch_ros.actions.Node`` in Jazzy."""

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
    """A lifecycle node."""


@dataclass(frozen=True)
class LaunchDescription:
    """The result of ``launch`` for a list of actions."""

    entities: list[Node]


@pytest.fixture
def launch(monkeypatch: pytest.MonkeyPatch) -> None:
    """Replace ``launch`` and ``launch_ros`` by a strict stand-in."""
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
    """Return the expected action of a node."""
    listed = {
        name: list(value) if isinstance(value, tuple) else value
        for name, value in node.plain_parameters
    }
    level = f"{node.logger}:={node.log_level}"
    return (LifecycleNode if node.lifecycle else Node)(
        package=node.package,
        executable=node.executable,
        name=node.name,
        namespace=str(node.namespace),
        output="screen",
        parameters=[listed] if listed else (),
        remappings=[(str(name), str(target)) for name, target in node.remappings] or (),
        ros_arguments=["--log-level", level] if node.log_level else (),
        respawn=node.respawn_delay is not None,
        respawn_delay=node.respawn_delay,
        respawn_max_retries=-1 if node.respawn_max is None else node.respawn_max,
    )


def test_launch_file_matches_golden(golden: Golden) -> None:
    """The text for a system with every construct matches the reviewed one."""
    golden.check("rossystem_launch", rossystem_launch(load(EVERYTHING), CONTEXT))


@pytest.mark.usefixtures("launch")
def test_every_node_is_an_action_with_all_its_settings() -> None:
    """The actions are in the order of the model, with known arguments only."""
    system = load(EVERYTHING)
    view = relative(system_view(system, root=ANY_ROOT))
    assert actions(system) == [as_action(node) for node in view.nodes]


@pytest.mark.usefixtures("launch")
def test_doubles_stay_doubles_and_strings_strings() -> None:
    """Strings that look like YAML numbers, booleans or null stay strings."""
    eye = actions(load(EVERYTHING))[0]
    assert repr(eye.parameters[0]["exposure"]) == "1.0"
    assert eye.parameters[0]["lens"] == "on"
    assert eye.parameters[0]["labels"] == ["yes", "12", "", "it is ünicode ☃"]


@pytest.mark.usefixtures("launch")
def test_empty_system_has_a_launch_file(tmp_path: Path) -> None:
    """It does not fail, and has no unused import."""
    system = load_text(tmp_path, "system Empty")
    assert actions(system) == []
    write(rossystem_launch(system, CONTEXT), tmp_path / "out")
    assert_lint_clean(tmp_path / "out")


def test_launch_file_passes_the_ament_linters(tmp_path: Path) -> None:
    """flake8 and pep257 with ament's settings find nothing, even with long names."""
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


def test_real_launch_reads_the_file() -> None:
    """``launch_ros``, if installed, creates the same nodes."""
    actual = pytest.importorskip("launch_ros.actions")
    system = load(EVERYTHING)
    launched = actions(system)
    assert all(isinstance(action, actual.Node) for action in launched)
    assert len(launched) == len(list(system_view(system).nodes))
