"""Statements that start existing launch files: what their text becomes."""

from __future__ import annotations

from pathlib import Path

import pytest

from deros.metamodels.load import LoadedFile, Repository
from deros.models.system import NodeInstance, Subsystem, System

NODE = "node driver : drivers publishes topic launch : std_msgs.Bool topic provides : std_msgs.Bool"


def _load(folder: Path, body: str) -> LoadedFile:
    (folder / "driver.rnd").write_text(NODE)
    (folder / "launch.rnd").write_text(NODE.replace("driver :", "launch :"))
    return Repository().load_text(folder / "s.system", f'system S imports import "*.rnd" {body}')


def _system(folder: Path, body: str) -> System:
    loaded = _load(folder, body)
    assert loaded.diagnostics == ()
    assert isinstance(loaded.model, System)
    return loaded.model


def _statement(folder: Path, body: str) -> Subsystem:
    (member,) = _system(folder, body).members
    assert isinstance(member, Subsystem)
    return member


def test_statement_is_a_subsystem_of_the_nodes_that_it_describes(tmp_path: Path) -> None:
    """Its file, its arguments as texts, and what follows in any order."""
    found = _statement(
        tmp_path,
        'argument sim : bool = true launch "share:nav/launch/a.launch.py" (use_sim_time = true,'
        ' "my-name" = "x", count = 3, rate = 0.5, sim = $sim, both = "${sim}")'
        ' when sim as nav "Drives" namespace /left provides { node a : driver node b : driver };',
    )
    assert found.launch is not None
    assert found.launch.in_package == ("nav", "launch/a.launch.py")
    assert [(each.name, each.value) for each in found.launch.arguments] == [
        ("use_sim_time", "true"),
        ("my-name", "x"),
        ("count", "3"),
        ("rate", "0.5"),
        ("sim", "$sim"),
        ("both", '"${sim}"'),
    ]
    computed = [each.name for each in found.launch.arguments if each.value_from is not None]
    assert computed == ["sim", "both"]
    assert (found.name, found.namespace, found.description) == ("nav", "/left", "Drives")
    assert found.launch.is_described
    assert found.when is not None
    assert [each.name for each in found.members] == ["a", "b"]


@pytest.mark.parametrize(
    ("path", "name"),
    [
        ('"nav/navigation_launch.py"', "navigation"),
        ('"share:a/launch/b-c.launch.xml"', "b_c"),
        ('"2d.launch.yaml"', "launch_2d"),
        ('"${robot}.launch.py"', "robot"),
        ("$robot", "robot"),
        ('".py"', "launch"),
    ],
)
def test_name_is_that_of_the_file(tmp_path: Path, path: str, name: str) -> None:
    """It is the same for all values of arguments."""
    found = _statement(tmp_path, f"launch {path} argument robot : string")
    assert found.name == name
    assert found.launch is not None
    assert not found.launch.is_described


@pytest.mark.parametrize(
    "body",
    [
        "node launch : driver node provides : launch wirings connect launch to provides"
        " topics topic launch topic provides",
        "subsystem launch { node launch : driver } subsystem provides namespace launch { }",
        'argument launch : bool = true launch "a.py" (launch = $launch) when launch as launch',
        'process launch : "launch" arguments ["launch"] launch "b.py" as provides provides { }',
        'topics topic /a launch "a.py" (provides = 1) "provides" node n : driver "launch"',
    ],
)
def test_new_words_may_still_be_names(tmp_path: Path, body: str) -> None:
    """Nodes, ports, topics and arguments may be called like them."""
    _system(tmp_path, body)


def test_what_starts_a_node_is_refused_and_has_no_effect(tmp_path: Path) -> None:
    """The launch file starts the nodes, so only what they are can be said."""
    loaded = _load(
        tmp_path,
        'launch "a.py" provides { node a : driver respawn env A = 1 log_level debug prefix "x"'
        ' arguments ["-v"] autostart namespace n parameters param use_sim_time = true }',
    )
    assert sorted(each.message.split("'")[1] for each in loaded.diagnostics) == [
        *("arguments", "autostart", "env", "log_level", "prefix", "respawn"),
    ]
    assert isinstance(loaded.model, System)
    (statement,) = loaded.model.members
    assert isinstance(statement, Subsystem)
    (node,) = statement.members
    assert isinstance(node, NodeInstance)
    assert (node.respawn, node.environment, node.log_level, node.prefix) == (None, (), None, None)
    assert (node.arguments, node.autostart, node.namespace) == ((), None, "n")


@pytest.mark.parametrize(
    ("slip", "hint"),
    [
        ('include "nav.launch.py"', "write 'launch'"),
        ('launch "nav.launch.py" with robot = "r1"', "in parentheses"),
        ('launch "nav.launch.py" arguments ["robot:=r1"]', "in parentheses"),
        ('launch "nav.launch.py" (robot := "r1")', "write '=' instead of ':='"),
        ('launch "nav.launch.py" (robot = "r1") respawn', "remove it"),
        ('launch "nav.launch.py" env A = 1', "head of the system"),
    ],
)
def test_slips_have_hints(tmp_path: Path, slip: str, hint: str) -> None:
    """What other tools write instead is one error, which says what to write."""
    loaded = _load(tmp_path, f"\n{slip}\nnode last : driver")
    assert [each.code.name for each in loaded.diagnostics] == ["DRS003"]
    (found,) = loaded.diagnostics
    assert hint in found.hint
    assert found.span.line == 2
