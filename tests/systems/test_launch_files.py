"""The nodes of launch files at run time, and what is passed on to all of them."""

from __future__ import annotations

from pathlib import Path

from deros.models.system import System
from deros.systems.arguments.variants import Variants
from deros.systems.flat import FlatSystem
from deros.systems.flatten import flatten
from tests.support.systems import load_text

EYE = """node eye : eyes
  lifecycle
parameters name rate : double = 1.0
publishes topic image : std_msgs.Bool topic other : std_msgs.Bool
"""
ARM = """system Arm
imports import "eye.rnd"
argument side : string
launch "${side}.launch.py" (side = $side, is_left = true) namespace $side provides {
  node grip : eye
}
"""


def _system(folder: Path, body: str) -> System:
    (folder / "eye.rnd").write_text(EYE)
    (folder / "arm.system").write_text(ARM)
    return load_text(folder, f'system S imports import "eye.rnd" import "arm.system" {body}')


def _flat(folder: Path, body: str) -> FlatSystem:
    return flatten(_system(folder, body))


def test_described_nodes_are_below_the_namespace_and_not_started(tmp_path: Path) -> None:
    """They are nodes of the system, and no programs that it starts."""
    flat = _flat(
        tmp_path,
        'subsystem a namespace a autostart { node x : eye launch "l.py" namespace b provides {'
        " node y : eye node z : eye namespace c } node w : eye }",
    )
    assert [(each.full_name, each.launch is not None) for each in flat.nodes] == [
        ("/a/x", False),
        ("/a/b/y", True),
        ("/a/b/c/z", True),
        ("/a/w", False),
    ]
    assert [each.full_name for each in flat.programs] == ["/a/x", "a/l", "/a/w"]
    assert [each.autostart is None for each in flat.nodes] == [False, True, True, False]
    assert flat.launches[0].namespace == "/a/b"


def test_programs_keep_their_order(tmp_path: Path) -> None:
    """Also where processes and launch files follow each other without a node between."""
    flat = _flat(
        tmp_path,
        'launch "b.py" process p : "x" launch "a.py" provides { node i : eye } process q : "x"'
        ' node n : eye launch "c.py"',
    )
    names = [each.instance.name for each in flat.programs]
    assert names == ["b", "p", "a", "q", "n", "c"]


def test_groups_are_passed_on_the_innermost_first(tmp_path: Path) -> None:
    """Variables, parameters, remappings and files; a used system has its own arguments."""
    flat = _flat(
        tmp_path,
        'env A = "1" env B = "1" parameters param rate = 1.0 parameters from "one.yaml"'
        ' subsystem arm : Arm(side = "left") namespace arms { env A = "2"'
        ' parameters param rate = 2.0 parameters from "two.yaml" remappings remap x to y }',
    )
    (found,) = flat.launches
    assert {each.name: each.value.text for each in found.environment} == {"A": "2", "B": "1"}
    assert [(each.name, each.value) for each in found.parameters] == [("rate", 2.0)]
    assert [(each.name, each.target) for each in found.remappings] == [("x", "y")]
    assert [each.path for each in found.files] == ["one.yaml", "two.yaml"]
    assert found.launch.path == "left.launch.py"
    assert [each.value for each in found.launch.arguments] == ["left", "true"]
    assert (found.namespace, found.full_name) == ("/arms/left", "arm/side")


def test_remapping_of_a_group_comes_before_those_of_the_launch_file(tmp_path: Path) -> None:
    """``launch`` hands it over first, and the first one counts; for other nodes it is the last."""
    group = "remappings remap image to moved"
    node = "wirings connect image to own connect other to own"
    topics = "topics topic moved topic own"
    flat = _flat(
        tmp_path,
        f'{group} {topics} launch "l.py" provides {{ node y : eye {node} }} node x : eye {node}',
    )
    ends = {node.full_name: [port.topic for port in node.ports] for node in flat.nodes}
    assert ends == {"/y": ["/moved", "/own"], "/x": ["/own", "/own"]}
    assert flat.nodes[0].parameters == ()


def test_parameter_of_the_launch_file_comes_before_that_of_a_group(tmp_path: Path) -> None:
    """As that of any node does."""
    flat = _flat(
        tmp_path,
        'parameters param rate = 1.0 launch "l.py" provides { node y : eye parameters'
        " param rate = 2.0 node z : eye }",
    )
    assert [dict(each.parameters) for each in flat.nodes] == [{"rate": 2.0}, {"rate": 1.0}]


def test_every_form_of_a_launch_file_is_looked_at(tmp_path: Path) -> None:
    """Each path that arguments can give, with the file and without it."""
    system = _system(
        tmp_path,
        'argument floor : string = "a" one_of ["a", "b"] argument on : bool = true'
        ' argument more : string launch "${floor}.py" (x = $more, floor = $floor) when on',
    )
    variants = Variants(system)
    flats = [variants.flat(number) for number in variants.numbers]
    paths = {tuple(each.launch.path for each in flat.launches) for flat in flats}
    assert paths == {(), ("a.py",), ("b.py",)}
    (found,) = flatten(system).launches
    assumed = {each.name: each.is_assumed for each in found.launch.arguments}
    assert assumed == {"x": True, "floor": False}
