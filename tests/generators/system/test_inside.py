"""Every way of starting a system gives a program the same for the nodes in its process."""

from __future__ import annotations

import ast
from pathlib import Path
from typing import Any

import pytest
import yaml

from deros.generators.api.protocol import GenerationError
from deros.generators.builtin import (
    rossystem_launch,
    rossystem_params,
    rossystem_script,
    rossystem_sros2,
    rossystem_systemd,
)
from deros.generators.system.script.generate import table
from deros.generators.system.script.standalone.command_line import command_line, parameter_file
from deros.generators.system.script.standalone.node import Inside, Node, Program, Row
from deros.generators.system.view import system_view
from deros.models.system import System
from deros.systems.arguments.resolve import resolve
from tests.support import launch
from tests.support.lint import assert_lint_clean
from tests.support.systems import CONTEXT, load_text

MANAGER = """node manager : control
parameters name rate : int = 100 name label : string = ""
publishes topic state : std_msgs.Bool
"""
WHEELS = """node wheels : controllers
parameters name radius : double = 1.0 name frames : string[] = ["base"]
publishes topic ~/odom : std_msgs.Bool
"""
BODY = """
argument drives : bool = true
argument robot : string = "r1"
topics topic /odom topic /far topic /state
node manager : manager NAMED namespace $robot respawn
parameters param rate = 25
wirings connect state to /state
inside manager {
  node wheels : wheels namespace $robot when drives
  parameters param radius = 2 param frames = ["a", "b"] when robot = "r1"
  wirings connect ~/odom to /odom
  node far : wheels namespace /far
  wirings connect ~/odom to /far
}
"""


def load(folder: Path, body: str = BODY.replace("NAMED", "own_name")) -> System:
    """Load a system of a manager and its controllers."""
    text = f'system Shared imports import "*.rnd" {body}'
    return load_text(folder, text, manager=MANAGER, wheels=WHEELS)


def rows(system: System, **values: object) -> tuple[Row, ...]:
    """Return the rows of the table that the script and ``deros up`` run."""
    return table(system_view(resolve(system, values)))  # type: ignore[arg-type]


def words(row: Row) -> list[str]:
    """Return what a program is given before its parameters."""
    line = command_line(row, ["run"], "FILE")
    return [each for each in line[1:] if each != "-r"]


def read(text: str | bytes) -> dict[str, Any]:
    """Return the parameters in a file, by the full names of their nodes."""
    return {name: each["ros__parameters"] for name, each in yaml.safe_load(text).items()}


# What is started ----------------------------------------------------------------------------------


def test_nodes_in_a_process_are_not_started(tmp_path: Path) -> None:
    """The only row is that of the program, with the nodes that are there."""
    for drives, names in ((True, ["/r1/wheels", "/far/far"]), (False, ["/far/far"])):
        (row,) = rows(load(tmp_path), drives=drives)
        assert row.full_name == "/r1/manager"
        assert [each.full_name for each in row.inside] == names


def test_rules_for_one_node_come_before_those_for_all(tmp_path: Path) -> None:
    """Of several rules of ROS 2 the first one counts."""
    (row,) = rows(load(tmp_path))
    files = ["__ns:=/r1", "--params-file", "FILE"]
    remapped = ["manager:state:=/state", "wheels:~/odom:=/odom", "far:~/odom:=/far"]
    assert words(row) == ["--ros-args", "far:__ns:=/far", *files, *remapped]
    (row,) = rows(load(tmp_path, BODY.replace("NAMED", "")))
    names = ["wheels:__node:=wheels", "far:__node:=far", "far:__ns:=/far", "__node:=manager"]
    assert words(row) == ["--ros-args", *names, *files, *remapped]


def test_parameters_are_for_one_node_each(tmp_path: Path) -> None:
    """They stand in a file under full names; those of the program, too."""
    (row,) = rows(load(tmp_path))
    text = parameter_file(row)
    assert text is not None
    assert read(text) == {
        "/r1/manager": {"rate": 25},
        "/r1/wheels": {"radius": 2.0, "frames": ["a", "b"]},
    }
    (row,) = rows(load(tmp_path), robot="r2", drives=False)
    text = parameter_file(row)
    assert text is not None
    assert read(text) == {"/r2/manager": {"rate": 25}}


def test_own_name_alone_leaves_the_command_line(tmp_path: Path) -> None:
    """The node is not renamed; its parameters are for its process, as launch has them."""
    (row,) = rows(load(tmp_path, "node manager : manager own_name parameters param rate = 2"))
    assert command_line(row, ["run"]) == ["run", "--ros-args", "-r", "__ns:=/", "-p", "rate:=2"]
    assert parameter_file(row) is None


PROCESS = """
argument ns : string = "arm"
process sim : "sim" arguments ["-v", $ns]
topics topic /odom
inside sim { node wheels : wheels namespace $ns GIVEN }
"""


def test_process_gets_what_is_for_nodes_in_it(tmp_path: Path) -> None:
    """It has arguments of ROS 2 only if there is something for it to be told."""
    given = "parameters param radius = 2 wirings connect ~/odom to /odom"
    (row,) = rows(load(tmp_path, PROCESS.replace("GIVEN", given)))
    ros = ["wheels:__ns:=/arm", "wheels:~/odom:=/odom", "--params-file", "FILE"]
    assert words(row) == ["-v", "arm", "--ros-args", *ros]
    (row,) = rows(load(tmp_path, PROCESS.replace("GIVEN", "").replace("namespace $ns", "")))
    assert command_line(row, ["run"]) == ["run", "-v", "arm"]


def test_all_nodes_of_a_process_read_its_files(tmp_path: Path) -> None:
    """Those of a node in it are among them, and count for the others as well."""
    (tmp_path / "all.yaml").write_text("/**: {ros__parameters: {radius: 3.0}}")
    (tmp_path / "own.yaml").write_text("manager: {ros__parameters: {label: x}}")
    body = (
        'node manager : manager parameters from "all.yaml" '
        'inside manager { node wheels : wheels parameters from "own.yaml" }'
    )
    system = load(tmp_path, body)
    (row,) = rows(system)
    assert [Path(each).name for each in row.files] == ["all.yaml", "own.yaml"]
    text = rossystem_params(system, CONTEXT)["shared.params.yaml"].text
    assert read(text) == {"/manager": {"radius": 3.0, "label": "x"}, "/wheels": {"radius": 3.0}}


def test_process_of_a_component_is_that_of_its_container(tmp_path: Path) -> None:
    """In each variant, whichever it is; the service that loads has no words for other nodes."""
    body = """
    argument composed : bool = true argument drives : bool = true
    topics topic /odom
    container main namespace /boxes { }
    node manager : manager plugin "a::B" into main when composed
    inside manager { node wheels : wheels when drives wirings connect ~/odom to /odom }
    """
    system = load(tmp_path, body)
    for composed, process in ((True, "main"), (False, "manager")):
        for drives in (True, False):
            found = rows(system, composed=composed, drives=drives)
            names = {each.name: [node.name for node in each.inside] for each in found}
            assert names == {"main": [], "manager": []} | ({process: ["wheels"]} if drives else {})
    (file,) = rossystem_launch(system, CONTEXT).values()
    rules = ["wheels:__node:=wheels", "wheels:__ns:=/", "__node:=main", "__ns:=/boxes"]
    assert launch.shared(file.text, {})[0] == ([*rules, "wheels:~/odom:=/odom"], {})
    container, manager = launch.shared(file.text, {"composed": "false"})
    assert container == (["__node:=main", "__ns:=/boxes"], {})
    assert "wheels:~/odom:=/odom" in manager[0]


# All starters -------------------------------------------------------------------------------------


@pytest.mark.parametrize("named", ["", "own_name"])
@pytest.mark.parametrize("drives", [True, False])
@pytest.mark.parametrize("robot", ["r1", "r2"])
def test_launch_file_says_what_the_rows_say(
    tmp_path: Path, named: str, drives: bool, robot: str
) -> None:
    """Names, remappings, and parameters of each node are those of the table."""
    system = load(tmp_path, BODY.replace("NAMED", named))
    (file,) = rossystem_launch(system, CONTEXT).values()
    (tmp_path / "lint").mkdir()
    (tmp_path / "lint" / "shared.launch.py").write_text(file.text)
    assert_lint_clean(tmp_path / "lint")
    (row,) = rows(system, drives=drives, robot=robot)
    assert isinstance(row, Node)
    given = {"drives": str(drives).lower(), "robot": robot}
    ((rules, parameters),) = launch.shared(file.text, given)
    assert rules == [each for each in words(row) if ":=" in each]
    text = parameter_file(row)
    assert parameters == read(text or "")
    ((rules, _),) = launch.shared(file.text, given, namespace="/fleet")
    assert f"__ns:=/fleet/{robot}" in rules
    assert "far:__ns:=/far" in rules, "an absolute namespace is that of no includer"


def test_launch_file_starts_the_process_as_the_row_does(tmp_path: Path) -> None:
    """With the namespace of whoever includes the file before that of the node."""
    given = "parameters param radius = 2 wirings connect ~/odom to /odom"
    system = load(tmp_path, PROCESS.replace("GIVEN", given))
    (file,) = rossystem_launch(system, CONTEXT).values()
    (row,) = rows(system)
    ((rules, parameters),) = launch.shared(file.text, {})
    assert rules == [each for each in words(row) if ":=" in each]
    assert parameters == {"/arm/wheels": {"radius": 2.0}}
    ((rules, _),) = launch.shared(file.text, {}, namespace="/fleet")
    assert rules[0] == "wheels:__ns:=/fleet/arm"


def test_script_has_the_rows_of_its_table(tmp_path: Path) -> None:
    """Its text says the same as ``deros up`` runs."""
    body = (
        "node manager : manager own_name "
        "inside manager { node wheels : wheels parameters param radius = 2 } "
        'process sim : "sim" inside sim { node far : wheels namespace far '
        "wirings connect ~/odom to /odom } topics topic /odom"
    )
    system = load(tmp_path, body)
    (file,) = rossystem_script(system, CONTEXT).values()
    (tmp_path / "lint").mkdir()
    (tmp_path / "lint" / "shared.py").write_text(file.text)
    assert_lint_clean(tmp_path / "lint")
    (assigned,) = (
        each.value
        for each in ast.parse(file.text).body
        if isinstance(each, ast.AnnAssign) and ast.unparse(each.target) == "NODES"
    )
    assert assigned is not None
    names = {"Node": Node, "Program": Program, "Inside": Inside}
    assert list(eval(ast.unparse(assigned), names)) == list(rows(system))


def test_launch_file_has_what_it_needs_and_no_more(tmp_path: Path) -> None:
    """Without parameters of its own, no file has to be written for a node."""
    (tmp_path / "p.yaml").write_text("manager: {ros__parameters: {rate: 3}}")
    body = 'node manager : manager own_name parameters from "p.yaml" GIVEN'
    for given, is_written in (("", False), ('parameters param label = "x"', True)):
        made = rossystem_launch(load(tmp_path, body.replace("GIVEN", given)), CONTEXT)
        text = str(made["shared.launch.py"].text)
        assert ("ParametersOf" in text) == is_written
        assert "__node" not in text
        assert "name='manager'" not in text


def test_units_have_the_words_of_the_rows(tmp_path: Path) -> None:
    """But for parameters, which need a file."""
    body = "node manager : manager inside manager { node wheels : wheels GIVEN } topics topic /odom"
    remapped = load(tmp_path, body.replace("GIVEN", "wirings connect ~/odom to /odom"))
    text = rossystem_systemd(remapped, CONTEXT)["systemd/shared-manager.service"].text
    lines = [each.strip(" \\") for each in text.splitlines()]
    (row,) = rows(remapped)
    rules = [each for each in words(row) if ":=" in each]
    assert [each for each in lines if each.startswith("-r ")] == [f"-r {each}" for each in rules]
    given = load(tmp_path, body.replace("GIVEN", "parameters param radius = 2"))
    with pytest.raises(GenerationError, match="in the process of 'manager'"):
        rossystem_systemd(given, CONTEXT)


def test_policy_is_for_the_enclave_of_the_process(tmp_path: Path) -> None:
    """A node in it has no enclave of its own; of a process that is not a node it is the root."""
    body = (
        'node manager : manager inside manager { node wheels : wheels } process sim : "sim" '
        "inside sim { node far : wheels namespace far }"
    )
    text = rossystem_sros2(load(tmp_path, body), CONTEXT)["shared.policy.xml"].text
    marks = ("<enclave path=", "<profile ns=")
    found = [line.strip() for line in text.splitlines() if line.strip().startswith(marks)]
    assert found == [
        '<enclave path="/">',
        '<profile ns="/far" node="far">',
        '<enclave path="/manager">',
        '<profile ns="/" node="manager">',
        '<profile ns="/" node="wheels">',
    ]


def test_launch_brings_no_node_to_active_that_it_does_not_name(tmp_path: Path) -> None:
    """It would wait for the node under a name that nobody has told it."""
    text = 'system S imports import "m.rnd" node m : m own_name autostart'
    system = load_text(tmp_path, text, m="node m : p lifecycle")
    with pytest.raises(GenerationError, match="has its own name"):
        rossystem_launch(system, CONTEXT)
    (row,) = rows(system)
    assert isinstance(row, Node)
    assert row.autostart is not None
