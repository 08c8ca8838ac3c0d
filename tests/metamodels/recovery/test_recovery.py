"""Syntax errors: each is reported, sound statements are read, and reading takes bounded time."""

from __future__ import annotations

import pytest

from deros import codes
from deros.diagnostics import Diagnostic
from deros.metamodels.grammar import literal_of
from deros.metamodels.languages import LANGUAGES, Language
from deros.metamodels.load import LoadedFile, Repository
from deros.metamodels.recovery.recovery import MOST_ERRORS, recogniser
from deros.models.node import NodeType
from deros.models.rules import Rules
from deros.models.system import NodeInstance, System
from tests.support.profiles import slow
from tests.support.work import calls

# Each line with an error ends in "// here".
NODE = """\
node camera : camera_driver
parameters
  name width double = 640                   // here
  name height : integer = 480
  name frame : string := "camera"           // here
  nmae rate : double = 30.0                 // here
  name gain : double = 1.0 in [0, 10;       // here
publishers                                  // here
  topic image : sensor_msgs.Image
  topic info sensor_msgs.CameraInfo         // here
subscribes
  topic trigger : std_msgs.Empty qos reliabel  // here
  topic stop : std_msgs.Bool qos depth ten  // here
services
  service reset std_srvs.Trigger            // here
timers
  timer grab evry 20 ms                     // here
  timer poll every 1 sec
"""
SYSTEM = """\
system Demo
imports
  import camera.rnd                         // here
topics
  topic /image : : sensor_msgs.Image        // here
  topc /info                                // here
  topic /stop
node front camera                           // here
  namespace /front
  parameters
    param width 320                         // here
    param height = 240
  wirings
    connect image -> /image                 // here
    connect info /info                      // here
    connect stop to /stop
subsystem {                                 // here
  node rear : camera
}
node side : camera respwan                  // here
node top : camera
  parameter                                 // here
    param width = 10
"""
RULES = """\
use "demo.system" improt Demo               // here
action stop
const limit 0.5 m/s                         // here
const most == 2                             // here
input speed = topic /odom.twist.twist.linear.x timeot 0.5 sec  // here
input pose = topic /odom.pose.pose.position.x
entity drive {
  fast: speed >> limit;                     // here
  far: pose > 3 m && speed > 0;             // here
  gone: pose.missing(;                      // here
  near: pose < 1 m;
}
if drive.fast { stop; }                     // here
if drive.far than { stop; }                 // here
if drive.near then { stop; }
gate /a to /b : geometry_msgs.Twist rate 10 Hz {  // here
  lost input for 1 sec: zero;
}
"""
FILES = {"camera.rnd": NODE, "demo.system": SYSTEM, "demo.deros": RULES}


def _load(name: str, text: str) -> LoadedFile:
    return Repository().load_text(name, text)


def _errors(loaded: LoadedFile) -> list[Diagnostic]:
    return [
        diagnostic for diagnostic in loaded.diagnostics if diagnostic.code is codes.SYNTAX_ERROR
    ]


@pytest.mark.parametrize("name", FILES)
def test_every_syntax_error_is_reported_once(name: str) -> None:
    """Ten errors in one file are ten findings, each on its own line."""
    text = FILES[name]
    wrong = [number for number, line in enumerate(text.splitlines(), 1) if "// here" in line]
    reported = sorted(error.span.line for error in _errors(_load(name, text)))
    assert len(wrong) >= 10
    assert reported == wrong


def test_sound_parts_of_a_broken_node_are_read() -> None:
    """Sound and repaired statements are in the model, with the right spans."""
    loaded = _load("camera.rnd", NODE)
    node = loaded.model
    assert isinstance(node, NodeType)
    assert [parameter.name for parameter in node.parameters] == ["width", "height", "frame", "rate"]
    assert [port.name for port in node.ports] == ["image", "info", "trigger", "reset"]
    assert [timer.name for timer in node.timers] == ["grab", "poll"]
    named = [(parameter.name, parameter.name_span) for parameter in node.parameters]
    named += [(port.name, port.name_span) for port in node.ports]
    assert all(span.text == name for name, span in named)
    assert all(timer.name_span.text == timer.name for timer in node.timers)
    assert loaded.source is not None
    assert {"gain", "stop"} <= loaded.source.lost


def test_sound_parts_of_a_broken_system_are_read() -> None:
    """A node with a broken header or wiring keeps its sound parts."""
    system = _load("demo.system", SYSTEM).model
    assert isinstance(system, System)
    nodes = [member for member in system.members if isinstance(member, NodeInstance)]
    assert [node.name for node in nodes] == ["front", "side", "top"]
    assert [parameter.name for parameter in nodes[0].parameters] == ["width", "height"]
    assert [each.port for each in nodes[0].wirings] == ["image", "info", "stop"]
    for wiring in nodes[0].wirings:
        assert wiring.target_span.text == wiring.target


def test_sound_parts_of_broken_rules_are_read() -> None:
    """Rules, inputs and behaviours next to broken ones are in the model."""
    rules = _load("demo.deros", RULES).model
    assert isinstance(rules, Rules)
    assert "pose" in [each.name.text for each in rules.inputs]
    assert [rule.name.text for rule in rules.entities[0].rules] == ["far", "gone", "near"]
    assert len(rules.behaviours) == 3


@pytest.mark.parametrize(
    ("name", "text"),
    [
        ("a.rnd", "nod camera : camera_driver\nparameters\n  name a : double ? 1\n"),
        ("a.rnd", "node 3d : camera_driver\nparameters\n  name a : double ? 1\n"),
        ("a.system", "system 1\ntopics\n  topic ?\n"),
        ("a.system", "system 1\n\nnode 2 : b\n"),
    ],
)
def test_broken_header_does_not_hide_later_errors(name: str, text: str) -> None:
    """Errors after an unreadable header are reported as well."""
    assert [error.span.line for error in _errors(_load(name, text))] == [1, 3]


@pytest.mark.parametrize(
    ("name", "text", "edited"),
    [
        ("a.rnd", "node a p", "node a: p"),
        ("a.rnd", "node a : p\npublisher\n", "node a : p\npublishes\n"),
        ("a.system", "system A\ntopic /x", "system A\ntopics topic /x"),
        (
            "a.system",
            'system A\nparameters param d = xacro "a.xacro" (b = 1)\n',
            'system A\nparameters param d from xacro "a.xacro" (b = 1)\n',
        ),
        (
            "a.system",
            "system A\nparameters param d = from xacro $a\n",
            "system A\nparameters param d from xacro $a\n",
        ),
        (
            "a.system",
            'system A\nfile w = xacro "a.xacro" (b = 1)\n',
            'system A\nfile w from xacro "a.xacro" (b = 1)\n',
        ),
        ("a.system", 'system A\nparameters from "a.yaml" root_key = b\n',
         'system A\nparameters from "a.yaml" below b\n'),
        ("a.system", "system A\nnode n : m\nwirings connect publisher to to /x\n",
         'system A\nnode n : m\nwirings connect publisher "to" to /x\n'),
        ("a.system", "system A\nsubsystem s {\n  topics topic /x\n",
         "system A\nsubsystem s {\n  topics topic /x\n}\n"),
        ("a.deros", "if a.b { stop; }", "if a.b then { stop; }"),
        ("a.deros", "entity e {\n  r: a > 1;\nif e.r then { stop; }",
         "entity e {\n  r: a > 1;\n}\nif e.r then { stop; }"),
        ("a.deros", "gate /a to /b : c.D rate 1 Hz { lost input for 1 s: zero }",
         "gate /a -> /b : c.D rate 1 Hz { lost input for 1 s: zero }"),
    ],
)  # fmt: skip
def test_fix_repairs_the_statement(name: str, text: str, edited: str) -> None:
    """A certain fix is part of the finding, and the fixed text parses."""
    (finding,) = _errors(_load(name, text))
    assert finding.fix is not None
    span = finding.fix.span
    mended = f"{text[: span.start]}{finding.fix.text}{text[span.end :]}"
    assert mended == edited
    assert not _errors(_load(name, mended))


@pytest.mark.parametrize("language", LANGUAGES)
def test_statements_are_derived_from_the_grammar(language: Language) -> None:
    """The statements and their first tokens are read from the grammar."""
    known = {
        "rosnode": {"name", "topic", "service", "timer", "parameters", "executable"},
        "rossystem": {"import", "topic", "param", "connect", "node", "subsystem", "wirings"},
        "deros": {"use", "const", "input", "entity", "if", "gate", "lost"},
    }
    steps = recogniser(language)
    first = {literal_of(token) for each in steps.lists for token in each.first}
    assert known[language.name] <= first


@pytest.mark.parametrize(
    ("name", "text"),
    [
        ("a.rnd", "node a : p\nparameters\nparameter"),
        ("a.rnd", "node a : p\nsubscribes\nsubscriber"),
        ("a.system", "system a\ntopics\ntopc"),
    ],
)
def test_span_of_a_repaired_last_word_stays_in_the_file(name: str, text: str) -> None:
    """A finding about a word that was read as a longer one ends with the file."""
    for diagnostic in _load(name, text).diagnostics:
        assert 0 <= diagnostic.span.start <= diagnostic.span.end <= len(text)


def test_findings_beyond_the_limit_are_counted() -> None:
    """Of ten thousand errors, fifty are shown and the rest are counted."""
    text = "node a : b\nparameters\n" + "  name x : double ? 1.0\n" * 10_000
    *shown, rest = _load("a.rnd", text).diagnostics
    assert len(shown) == MOST_ERRORS
    assert rest.code is codes.MORE_SYNTAX_ERRORS
    assert "9950" in rest.message


MOST_CALLS = 8_000_000
"""Some seconds of work: a slow machine makes a million calls in one."""


@pytest.mark.parametrize(
    ("name", "text"),
    [
        slow("a.rnd", "node a : b\nparameters\n" + "  name x double = 1.0\n" * 10_000),
        ("a.rnd", "node a : b\nparameters\n" + "  ? ? ?\n" * 10_000),
        ("a.rnd", "node a : b publishes " + "topic x :" * 20_000),
        ("a.system", "system a\n" + "subsystem x {\n" * 90 + "node x : y wirings connect\n" * 999),
        ("a.system", "system a node " + "node : " * 20_000),
        slow("a.deros", "entity e {\n" + "  r: a > 1 ?? b;\n" * 10_000 + "}\n"),
        ("a.deros", "if a.b then { " * 99 + "? ; " * 1_000),
        ("a.deros", "if a.b then stop;\n" * 10_000),
        ("a.deros", "a: b\n" * 10_000),
        ("a.deros", "entity e {\n" + "word_without_colon\n" * 3_000),
        ("a.deros", "}" * 20_000),
    ],
)  # fmt: skip
def test_work_of_hostile_files_is_bounded(name: str, text: str) -> None:
    """Reading ends within seconds, however many errors there are and however deep."""
    found: list[Diagnostic] = []
    assert calls(lambda: found.extend(_load(name, text).diagnostics)) < MOST_CALLS
    assert found


def test_work_of_recovery_is_linear() -> None:
    """Eight times as much sound text before forty errors is about eight times the work."""

    def work(count: int) -> int:
        sound = "  name x : double = 1.0\n" * count
        text = f"node a : b\nparameters\n{sound}" + "  name y double\n" * 40
        return calls(lambda: _load("a.rnd", text))

    work(10)  # what is done once
    assert work(8_000) < 9 * work(1_000)
