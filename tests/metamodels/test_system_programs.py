"""What programs are started with, settings of groups, and processes: what their text becomes."""

from __future__ import annotations

from pathlib import Path

import pytest

from deros.metamodels.load import LoadedFile, Repository
from deros.models.programs import Respawn
from deros.models.system import NodeInstance, Subsystem, System

NODE = """node camera : cameras
parameters name env : string = "a" name process : double = 1.0
publishes topic prefix : std_msgs.Bool topic remappings : std_msgs.Bool
"""


def _load(folder: Path, body: str) -> LoadedFile:
    for name in ("camera", "arguments", "cwd"):
        (folder / f"{name}.rnd").write_text(NODE.replace("camera :", f"{name} :"))
    (folder / "arm.system").write_text("system Arm")
    return Repository().load_text(
        folder / "s.system", f'system S imports import "*.rnd" import "arm.system" {body}'
    )


def _system(folder: Path, body: str) -> System:
    loaded = _load(folder, body)
    assert loaded.diagnostics == ()
    assert isinstance(loaded.model, System)
    return loaded.model


def test_modifiers_of_programs_are_read_in_any_order(tmp_path: Path) -> None:
    """Words keep their order and their text; an integer is the text of its digits."""
    (node,) = _system(
        tmp_path,
        'argument level : int = 1 node n : camera prefix "gdb --args" env B = 2'
        ' arguments ["-d", "a b", 007, -3, $level, "${level}x", ""] respawn env A = $level',
    ).members
    assert isinstance(node, NodeInstance)
    assert [word.text for word in node.arguments if word.text_from is None] == [
        *("-d", "a b", "007", "-3", ""),
    ]
    assert [each.text_from is None for each in node.arguments] == [
        *(True, True, True, True, False, False, True),
    ]
    assert [(each.name, each.value.text) for each in node.environment] == [
        ("B", "2"),
        ("A", "$level"),
    ]
    assert node.prefix is not None
    assert node.prefix.text == "gdb --args"


def test_process_has_all_that_a_program_has(tmp_path: Path) -> None:
    """Program, words, variables, prefix, folder, respawn, condition and description."""
    (process,) = _system(
        tmp_path,
        'argument on : bool = true process bag : "recorder" arguments ["bag"] env A = "b"'
        ' cwd "/tmp" prefix "nice" respawn delay 2 sec max 3 when on "Records";',
    ).processes
    assert (process.name, process.program.text, process.description) == (
        "bag",
        "recorder",
        "Records",
    )
    assert process.folder is not None
    assert process.folder.text == "/tmp"
    assert process.respawn == Respawn(2_000_000_000, 3)
    assert process.when is not None
    assert [word.text for word in process.words] == ["recorder", "bag", "nice", "/tmp", "b"]


def test_settings_at_the_head_are_those_of_the_group(tmp_path: Path) -> None:
    """They may stand before and behind topics; behind a node, `parameters` is the node's."""
    system = _system(
        tmp_path,
        'env A = "1"; parameters param use_sim_time = true topics topic /x env B = "2"'
        " remappings remap /tf to tf remap ~/x to /y;"
        " subsystem s { parameters param process = 2 node n : camera parameters param env = $a }"
        " argument a : string",
    )
    assert [each.name for each in system.settings.environment] == ["A", "B"]
    assert [each.name for each in system.settings.parameters] == ["use_sim_time"]
    assert [(each.name, each.target) for each in system.settings.remappings] == [
        ("/tf", "tf"),
        ("~/x", "/y"),
    ]
    (subsystem,) = system.members
    assert isinstance(subsystem, Subsystem)
    assert [each.name for each in subsystem.settings.parameters] == ["process"]
    assert system.is_computed


@pytest.mark.parametrize(
    "body",
    [
        "node env : arguments node process : cwd parameters param env = $process"
        " argument process : string",
        "subsystem arguments { node prefix : camera wirings connect prefix to env"
        " connect remappings to remap } topics topic env topic remap topic cwd",
        "argument env : bool argument prefix : double = 1.0 node n : camera when env"
        " parameters param process = $prefix param env = 5 process p : $cwd argument cwd : string",
        "subsystem process namespace env { subsystem remappings namespace arguments { } }",
        'node n : camera activated by process process q : "x" prefix "y"',
        "topics topic /a qos parameters parameters param env = 5",
        'process env : "env" env env = "env" node n : camera respawn delay 5 sec env A = 1',
    ],
)
def test_new_words_may_still_be_names(tmp_path: Path, body: str) -> None:
    """Nodes, ports, topics, arguments and parameters may be called like them."""
    _system(tmp_path, body)


def test_used_system_may_be_given_settings_but_no_parts(tmp_path: Path) -> None:
    """In braces behind a system that is used stand settings for all that it consists of."""
    system = _load(
        tmp_path, 'subsystem arm : Arm { env A = "1" parameters param use_sim_time = true }'
    )
    assert system.diagnostics == ()
    refused = _load(tmp_path, 'subsystem arm : Arm { env A = "1" process p : "x" }')
    assert ["put the parts" in each.hint for each in refused.diagnostics] == [True]


@pytest.mark.parametrize(
    ("body", "message", "hint"),
    [
        ('node n : camera wirings env A = "1"', "stands behind node 'n'", "move it to the head"),
        (
            'process p : "x" parameters param env = "1"',
            "stands behind process 'p'",
            "a process has no parameters",
        ),
        ("subsystem x { } remappings remap a to b", "stands behind subsystem 'x'", "head"),
        ("parameters param a = 1 parameters param b = 1", "'parameters' is given twice", "one"),
        ('node n : camera prefix "a" prefix "b"', "'prefix' is given twice", "one"),
        ('process p : "x" cwd "/a" cwd "/b"', "'cwd' is given twice", "one"),
        ("node n : camera arguments [1.5]", "a double has several spellings", '"1.5"'),
        ("process p : true", "a bool has several spellings", '"true"'),
    ],
)
def test_faults_of_reading(tmp_path: Path, body: str, message: str, hint: str) -> None:
    """Each has one finding, which says what to do."""
    (found,) = _load(tmp_path, body).diagnostics
    assert message in found.message
    assert hint in found.hint
