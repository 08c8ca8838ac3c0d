"""Every way of starting a system loads the same nodes into the same containers."""

from __future__ import annotations

import ast
from pathlib import Path

import pytest

from deros import codes
from deros.generators.api.protocol import GenerationError
from deros.generators.builtin import rossystem_launch, rossystem_script
from deros.generators.output.writer import write
from deros.generators.system.launch.generate import generate as launch_file
from deros.generators.system.params.generate import generate as params
from deros.generators.system.script.generate import generate as script
from deros.generators.system.script.generate import table
from deros.generators.system.script.standalone.node import Node
from deros.generators.system.sros2.generate import generate as sros2
from deros.generators.system.systemd.generate import generate as systemd
from deros.generators.system.view import system_view
from deros.models.system import System
from deros.systems.arguments.resolve import resolve
from tests.support import launch
from tests.support.lint import assert_lint_clean
from tests.support.systems import CONTEXT, load_text

PART = """node part : parts plugin "parts::Part"
parameters name gain : double = 1.0 name label : string = "" name gains : double[] = [1.0]
publishes topic out : std_msgs.Bool
"""
BODY = """
argument composed : bool = true
argument robot : string = "r1"
topics topic /out
container main multi_threaded if robot = "r1" namespace /boxes arguments ["-v"] {
  node a : part namespace $robot
  parameters param gain = 2 param label = "${robot}_a" param gains = [1, 2]
  wirings connect out to /out
  node b : part namespace /deep when composed wirings connect out to "/${robot}/out"
}
node c : part namespace /c respawn intra_process into main when composed
parameters param gain = 3.5
container other when not composed { node d : part }
node e : part into "/${robot}/existing" intra_process if composed or robot = "arm"
node f : part into "/${robot}/existing"
"""


def load(folder: Path, body: str = BODY, part: str = PART) -> System:
    """Load a system of parts."""
    return load_text(folder, f'system Boxes imports import "*.rnd" {body}', part=part)


def rows(system: System, **values: object) -> list[Node]:
    """Return the rows of the table that the script and ``deros up`` run."""
    found = table(system_view(resolve(system, values)))  # type: ignore[arg-type]
    return [row for row in found if isinstance(row, Node)]


def _as_read(value: object) -> object:
    return list(value) if isinstance(value, tuple) else value


@pytest.mark.parametrize("composed", [True, False])
@pytest.mark.parametrize("robot", ["r1", "arm"])
def test_launch_file_loads_what_the_table_has(tmp_path: Path, composed: bool, robot: str) -> None:
    """Names, classes, parameters, remappings and order are those of the rows."""
    system = load(tmp_path)
    (file,) = rossystem_launch(system, CONTEXT).values()
    given = {"composed": str(composed).lower(), "robot": robot}
    nodes = rows(system, composed=composed, robot=robot)
    targets = list(dict.fromkeys(node.container for node in nodes if node.container))
    expected = [
        (
            node.container,
            node.full_name,
            node.package,
            node.plugin,
            {name: _as_read(value) for name, value in node.parameters.items()},
            dict(node.remappings),
            [{"use_intra_process_comms": True}] if node.intra_process else [],
        )
        for target in targets
        for node in nodes
        if node.container == target
    ]
    assert launch.loaded(file.text, given) == expected
    assert [(name, program) for name, program, *_ in launch.started(file.text, given)] == [
        (node.full_name, node.executable) for node in nodes if not node.container
    ]


def test_composed_nodes_of_each_variant(tmp_path: Path) -> None:
    """Either all of them are where the text says, or processes of their own."""
    system = load(tmp_path)
    found = {node.full_name: node.container for node in rows(system)}
    assert found == {
        "/boxes/main": "",
        "/r1/a": "/boxes/main",
        "/deep/b": "/boxes/main",
        "/c/c": "/boxes/main",
        "/e": "/r1/existing",
        "/f": "/r1/existing",
    }
    found = {node.full_name: node.container for node in rows(system, composed=False)}
    assert found["/c/c"] == ""
    assert found["/d"] == "/other"
    assert "/deep/b" not in found


def test_threads_and_pointers_by_argument(tmp_path: Path) -> None:
    """A word with `if` counts where its condition holds; the node is there all the same."""
    system = load(tmp_path)
    found = {
        (composed, robot): {
            node.name: node for node in rows(system, composed=composed, robot=robot)
        }
        for composed in (True, False)
        for robot in ("r1", "arm")
    }
    assert {key: each["main"].executable for key, each in found.items()} == {
        (True, "r1"): "component_container_mt",
        (False, "r1"): "component_container_mt",
        (True, "arm"): "component_container",
        (False, "arm"): "component_container",
    }
    assert [key for key, each in found.items() if not each["e"].intra_process] == [(False, "r1")]


def test_what_belongs_to_a_process_is_not_that_of_a_loaded_node(tmp_path: Path) -> None:
    """A node that may be either has it where it is a process."""
    system = load(tmp_path)
    loaded, alone = (
        next(node for node in rows(system, composed=value) if node.name == "c")
        for value in (True, False)
    )
    assert (loaded.respawn_delay, loaded.intra_process) == (None, True)
    assert (alone.respawn_delay, alone.intra_process) == (0.0, False)


def test_script_has_the_rows_of_its_table(tmp_path: Path) -> None:
    """Its text says the same as ``deros up`` runs."""
    body = "container main { node a : part intra_process parameters param gain = 2 }"
    system = load(tmp_path, body)
    (file,) = rossystem_script(system, CONTEXT).values()
    (assigned,) = (
        each.value
        for each in ast.parse(file.text).body
        if isinstance(each, ast.AnnAssign) and ast.unparse(each.target) == "NODES"
    )
    assert assigned is not None
    found = eval(ast.unparse(assigned), {"Node": Node})
    assert list(found) == rows(system)
    assert "supervisor=ComposingSupervisor" in file.text


def test_values_of_files_are_passed_to_the_container(tmp_path: Path) -> None:
    """A container reads no file; which sections are for a node is decided as ROS 2 decides it."""
    (tmp_path / "p.yaml").write_text(
        "/**:\n  ros__parameters: {gain: 2.5}\n/*/b:\n  ros__parameters: {label: other}\n"
        "/deep/a:\n  ros__parameters: {label: mine}\n"
    )
    body = """
    node b : part namespace /n parameters from "p.yaml"
    container main { node a : part namespace /deep parameters from "p.yaml" }
    """
    system = load(tmp_path, body)
    found = {node.name: node for node in rows(system)}
    assert dict(found["a"].parameters) == {"gain": 2.5, "label": "mine"}
    assert found["a"].files == ()
    assert len(found["b"].files) == 1
    (file,) = (f for name, f in rossystem_launch(system, CONTEXT).items() if name.endswith(".py"))
    ((*_, parameters, _, _),) = launch.loaded(file.text, {}, str(tmp_path))
    assert parameters == {"gain": 2.5, "label": "mine"}


def test_values_for_computed_names_are_as_in_the_model(tmp_path: Path) -> None:
    """What is for all nodes is passed; which other sections are for a node shows at the start."""
    (tmp_path / "all.yaml").write_text("/**: {ros__parameters: {gain: 2.5}}\n")
    (tmp_path / "other.yaml").write_text("/r1/b: {ros__parameters: {label: other}}\n")
    (tmp_path / "mine.yaml").write_text("/r1/a: {ros__parameters: {label: mine}}\n")
    body = """
    argument robot : string = "r1"
    container main { node a : part namespace $robot FILES }
    """
    for names in (["all"], ["all", "other"]):
        files = " ".join(f'parameters from "{each}.yaml"' for each in names)
        system = load(tmp_path, body.replace("FILES", files))
        (node,) = (row for row in rows(system, robot="r2") if row.container)
        text = script(system, CONTEXT, {})["boxes.py"].text
        assert dict(node.parameters) == {"gain": 2.5}
        assert "'gain': 2.5" in text
        assert "files=" not in text.partition("NODES")[2].partition("\n)\n")[0]
        (file,) = (f for f in rossystem_launch(system, CONTEXT).values() if "Launch" in f.text)
        ((*_, parameters, _, _),) = launch.loaded(file.text, {"robot": "r2"}, str(tmp_path))
        assert parameters == {"gain": 2.5}
    files = 'parameters from "all.yaml" parameters from "mine.yaml"'
    text = script(load(tmp_path, body.replace("FILES", files)), CONTEXT, {})["boxes.py"].text
    assert "all.yaml" in text
    assert "mine.yaml" in text
    assert "'gain'" not in text


def refused(system: System, generate: object) -> list[tuple[str, str]]:
    """Return what a generator refuses: the text at fault, and why."""
    with pytest.raises(GenerationError) as caught:
        generate(system, CONTEXT, {})  # type: ignore[operator]
    assert {each.code for each in caught.value.diagnostics} == {codes.UNSUPPORTED_BY_TARGET}
    return [(each.span.text, each.message) for each in caught.value.diagnostics]


def test_file_that_cannot_be_read_now_is_read_at_the_start(tmp_path: Path) -> None:
    """By the script, ``deros up`` and ``launch_ros``."""
    body = (
        'argument file : string = "p" container main '
        '{ node a : part parameters from "${file}.yaml" }'
    )
    system = load(tmp_path, body)
    (row,) = (each for each in rows(system) if each.container)
    assert row.files == (str(tmp_path / "p.yaml"),)
    text = script(system, CONTEXT, {})["boxes.py"].text
    assert "files=(\n                f'{given.file}.yaml',\n" in text
    (file,) = (f for name, f in rossystem_launch(system, CONTEXT).items() if name.endswith(".py"))
    _, _, composable = file.text.partition("ComposableNode(")
    assert "parameters=[" in composable
    assert "LaunchConfiguration('file')" in composable


def test_file_with_values_lacks_none_of_a_container(tmp_path: Path) -> None:
    """Those of a file that cannot be read would be missing in it."""
    body = 'container main { node a : part parameters from "share:nowhere/a.yaml" }'
    ((place, why),) = refused(load(tmp_path, body), params)
    assert place == '"share:nowhere/a.yaml"'
    assert "cannot be read now" in why


def test_launch_refuses_to_restart_what_it_cannot_fill(tmp_path: Path) -> None:
    """The script does that; an empty container may be started again by either."""
    body = "container main respawn { node a : part } container empty respawn { }"
    ((place, why),) = refused(load(tmp_path, body), launch_file)
    assert place == "main"
    assert "without its nodes" in why


LATE = """container late delay 2 sec on exit stop all { node a : part MODIFIERS }
container box { node b : part MODIFIERS }
"""


def test_launch_refuses_to_bring_up_what_is_loaded_later(tmp_path: Path) -> None:
    """It would be asked for its transitions before its container is there; the script waits."""
    part = PART.replace("parameters", "lifecycle parameters")
    system = load(tmp_path, LATE.replace("MODIFIERS", "autostart"), part)
    ((place, why),) = refused(system, launch_file)
    assert place == "a"
    assert "'/late'" in why
    late, *_ = rows(system)
    assert (late.delay, late.stops_all) == (2.0, True)
    (tmp_path / "plain").mkdir()
    assert rossystem_launch(load(tmp_path / "plain", LATE.replace("MODIFIERS", "")), CONTEXT)


def test_units_and_policies_are_refused_for_loaded_nodes(tmp_path: Path) -> None:
    """An empty container is a node like any other."""
    system = load(tmp_path, "container main { node a : part }")
    for generate in (systemd, sros2):
        ((_, why),) = refused(system, generate)
        assert "/main" in why
    assert systemd(load(tmp_path, "container main { }"), CONTEXT, {})


def test_files_pass_the_ament_linters(tmp_path: Path) -> None:
    """With and without managed nodes in containers."""
    system = load(tmp_path)
    write(rossystem_launch(system, CONTEXT), tmp_path / "out")
    write(rossystem_script(system, CONTEXT), tmp_path / "out")
    folder = tmp_path / "managed"
    folder.mkdir()
    part = PART.replace("parameters", "lifecycle parameters")
    system = load(folder, BODY.replace("node e : part", "node e : part autostart"), part)
    write(rossystem_launch(system, CONTEXT), tmp_path / "out2")
    write(rossystem_script(system, CONTEXT), tmp_path / "out2")
    assert_lint_clean(tmp_path / "out")
    assert_lint_clean(tmp_path / "out2")
