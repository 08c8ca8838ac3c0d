"""Every place where a ROS 2 name can be written rejects names that ROS 2 rejects.

The places come from the grammars, so that a new one must be added here before the tests pass.
"""

from __future__ import annotations

import re
from pathlib import Path

import pytest

from deros.diagnostics import Diagnostic
from tests.support.checks import checked

GRAMMARS = Path(__file__).resolve().parents[2] / "src" / "deros" / "metamodels"

NODE_FILE = """\
node base : base
parameters
  name odom_topic : string = "/odom"
publishes
  topic odom : nav_msgs.Odometry
  topic more : nav_msgs.Odometry via odom_topic
"""
SYSTEM = """\
system s
imports import "base.rnd"
topics topic /odom topic /more
subsystem a namespace /n {
  node base : base
  parameters
    HERE
  wirings connect odom to /odom connect more to /more
}
"""
RULES = """\
use "s.system" import s
action stop publishes true on /stop : std_msgs.Bool
input odom = topic /odom.twist.twist.linear.x timeout 1 sec
entity e { fast: odom > 1 m/s or odom.missing(); }
if e.fast then { stop; };
"""

TOPICS = ("/1a", "/a-b", "/a/", "/é", "/a~b", "~x", "/" + "a" * 250)
WORDS = ("aé", "éa", "a" * 256)

PLACES: dict[str, tuple[str, str, tuple[str, ...]]] = {
    # Rule.attribute of the grammar: suffix of the file, a text with NAME, names rejected there.
    "NodeType.name": (".rnd", "node NAME : base", WORDS),
    "NodeType.package": (".rnd", "node base : NAME", ("Base", "a__b", "a_", "b", *WORDS)),
    "Parameter.name": (
        ".rnd",
        "node n : base parameters name NAME : int",
        ("a..b", "a.", "aé", "éa"),
    ),
    "Timer.name": (".rnd", "node n : base timers timer NAME every 1 sec", WORDS),
    "TopicPort.name": (".rnd", "node n : base publishes topic NAME : std_msgs.Bool", TOPICS),
    "ServicePort.name": (".rnd", "node n : base services service NAME : std_srvs.Trigger", TOPICS),
    "ClientPort.name": (".rnd", "node n : base clients client NAME : std_srvs.Trigger", TOPICS),
    "ActionPort.name": (
        ".rnd",
        "node n : base actions action NAME : example_interfaces.Fibonacci",
        TOPICS,
    ),
    "Via.parameter": (
        ".rnd",
        'node n : base parameters name p : string = "NAME" publishes topic a : std_msgs.Bool via p',
        TOPICS,
    ),
    "System.name": (".system", "system NAME", WORDS),
    "ArgumentDeclaration.name": (".system", "system s argument NAME : bool", WORDS),
    "Topic.name": (".system", "system s topics topic NAME", (*TOPICS, "~/a", "~")),
    "Subsystem.name": (".system", "system s subsystem NAME { }", WORDS),
    "NodeInstance.name": (".system", "system s node NAME : base", WORDS),
    "ParameterFile.below": (
        ".system",
        'system s imports import "base.rnd" parameters from "x.yaml" below NAME node a : base',
        (*TOPICS, "~/a", "~"),
    ),
    "MadeFile.name": (".system", 'system s file NAME from xacro "x.xacro"', WORDS),
    "NodeName.name": (".system", 'system s safety "s.deros" as NAME', WORDS),
    "Package.package": (
        ".system",
        'system s safety "s.deros" package NAME',
        ("Base", "a__b", "a_", "b", *WORDS),
    ),
    "Namespace.namespace": (
        ".system",
        "system s subsystem a namespace NAME { }",
        (*TOPICS, "~", "~/a"),
    ),
    "Setting.name": (".system", SYSTEM.replace("HERE", "param NAME = 1"), ("a..b", "aé")),
    "Setting.value": (".system", SYSTEM.replace("HERE", 'param odom_topic = "NAME"'), TOPICS),
    "Wiring.target": (
        ".system",
        SYSTEM.replace("connect odom to /odom", "connect odom to NAME").replace("HERE", ""),
        TOPICS,
    ),
    "Wiring.port": (
        ".system",
        SYSTEM.replace("connect odom to /odom", "connect NAME to /odom").replace("HERE", ""),
        TOPICS,
    ),
    "HostDeclaration.name": (".system", 'system s on robot host robot "x" host NAME "y"', ("Aé",)),
    "OnHost.host": (".system", 'system s on NAME host robot "x"', ("Aé",)),
    "Container.name": (".system", "system s container NAME { }", WORDS),
    "Into.container": (".system", "system s node a : base into NAME", (*TOPICS, "~", "~/a")),
    "After.target": (
        ".system",
        'system s topics external topic /a process p : "x" after service NAME',
        (*TOPICS, "~", "~/a"),
    ),
    "ProcessInstance.name": (".system", 'system s process NAME : "x"', WORDS),
    "Variable.name": (".system", 'system s process p : "x" env NAME = "1"', ("Aé",)),
    "GroupVariable.name": (".system", 'system s env NAME = "1"', ("Aé",)),
    "Remapping.name": (".system", "system s node a : base remappings remap NAME to /a", TOPICS),
    "Remapping.target": (".system", "system s remappings remap /a to NAME", TOPICS),
    "Constant.name": (".deros", RULES + "const NAME = 1", WORDS),
    "Zone.name": (".deros", RULES + "zone NAME = circle (0, 0) 1 m", WORDS),
    "Input.name": (".deros", RULES + "input NAME = topic /odom.pose", WORDS),
    "Action.name": (".deros", RULES + "action NAME", WORDS),
    "ParameterName.name": (".deros", RULES + "action a(NAME)", WORDS),
    "Binding.topic": (
        ".deros",
        RULES + "action a publishes true on NAME : std_msgs.Bool",
        (*TOPICS, "~", "~/a"),
    ),
    "ServiceCall.service": (
        ".deros",
        RULES + "action a calls true on NAME : std_srvs.SetBool",
        (*TOPICS, "~", "~/a"),
    ),
    "Entity.name": (".deros", RULES + "entity NAME { }", WORDS),
    "Rule.name": (".deros", RULES + "entity f { NAME: odom > 1 m/s; }", WORDS),
    "Behaviour.name": (
        ".deros",
        RULES + "behaviour NAME: if e.fast then { stop; }",
        WORDS,
    ),
    "GateSource.topic": (
        ".deros",
        RULES + "gate NAME -> /b : geometry_msgs.Twist rate 20 Hz { stop: zero; }",
        (*TOPICS, "~", "~/a"),
    ),
    "Gate.target": (
        ".deros",
        RULES + "gate /b -> NAME : geometry_msgs.Twist rate 20 Hz { stop: zero; }",
        (*TOPICS, "~", "~/a"),
    ),
    "TopicTerm.topic": (
        ".deros",
        RULES + "input x = topic NAME.twist",
        (*TOPICS, "~", "~/a"),
    ),
}

REFERENCES = {
    "Subsystem.system": "names a system that an import defines",
    "LaunchArgument.name": "names an argument that the launch file declares",
    "Plain.parameter": "names a parameter",
    "Passed.name": "names an argument that the used system declares",
    "NodeInstance.type": "names a node type that an import defines",
    "Frame.switch": "names a parameter of the node",
    "ActivatedBy.manager": "names a node of the system",
    "InsideProcess.process": "names a program of the system",
    "Use.system": "names a system that the file defines",
    "UnitDefinition.name": "a unit is in no generated code",
    "ResetBy.action": "names an action that is declared",
    "ActionCall.action": "names an action that is declared",
    "GateLine.action": "names an action that is declared",
    "GateLimit.field": "names a field of the message",
    "Ramp.field": "names a field of the message",
    "SentField.field": "names a field of the message",
    "NameTerm.name": "names what the rules declare",
    "Call.function": "names a function of the table",
}
"""Places where only names declared elsewhere are valid: any other name is unknown."""

_ATTRIBUTE = re.compile(
    r"(\w+)[*+?]?=(?:GraphName\b|ComputedName\b|MarkedGraphName\b|Name\b|RosParameterName\b|PortName\b|TermName\b|\[\w+:Name\])"
)


def test_table_covers_all_name_attributes() -> None:
    """Each grammar attribute that is a name is in one of the two tables."""
    attributes: set[str] = set()
    for path in GRAMMARS.glob("*.tx"):
        for rule in re.finditer(r"^(\w+):(.*?);$", path.read_text(), re.DOTALL | re.MULTILINE):
            attributes.update(f"{rule[1]}.{name}" for name in _ATTRIBUTE.findall(rule[2]))
    assert attributes == (PLACES.keys() - {"Setting.value"}) | REFERENCES.keys()


def _check(folder: Path, place: str, name: str) -> list[Diagnostic]:
    """Return the findings of the model that has a name at a place."""
    suffix, template, _ = PLACES[place]
    model = folder / f"model{suffix}"
    return checked(model, texts={model: template.replace("NAME", name)})


@pytest.mark.parametrize("place", PLACES)
def test_only_valid_ros_names_are_accepted(tmp_path: Path, place: str) -> None:
    """The error points at an invalid name; a valid one shows that the text around it is sound."""
    suffix, template, names = PLACES[place]
    (tmp_path / "base.rnd").write_text(NODE_FILE)
    (tmp_path / "s.system").write_text(SYSTEM.replace("HERE", ""))
    at = template.index("NAME")
    for name in names:
        errors = [
            each
            for each in _check(tmp_path, place, name)
            if each.is_error and each.span.file.endswith(f"model{suffix}")
        ]
        # The span of a quoted name includes the quotes.
        places = range(at - 1, at + len(name))
        assert any(error.span.start in places for error in errors), (name, errors)

    sound = {"Wiring.port": "odom", "Setting.name": "odom_topic"}.get(place)
    if sound is None:
        sound = "/odom" if set(TOPICS) <= set(names) else "sound"
    refused = ("DRS003", "DRS007", "DRS105", "DRS223", "DRS265", "DRS332")
    findings = _check(tmp_path, place, sound)
    assert [each.message for each in findings if each.code.name in refused] == [], sound


FOREIGN_SYSTEM = """\
system és
imports import "base.rnd"
topics topic /odom topic /more
node én : base
wirings connect odom to /odom connect more to /more
"""
FOREIGN_RULES = """\
use "s.system" import és
action éstop;
const élimit = 1 m/s
input év = topic /odom.twist.twist.linear.x timeout 1 sec
entity ée { éfast: év > élimit or ésilent; ésilent: év.missing(); }
if ée.éfast or ée.ésilent then { éstop; };
"""


def test_name_that_begins_with_another_letter_is_one_finding(tmp_path: Path) -> None:
    """It stands for what it declares, so that all that refers to it is sound."""
    (tmp_path / "base.rnd").write_text(NODE_FILE)
    (tmp_path / "s.system").write_text(FOREIGN_SYSTEM)
    (tmp_path / "r.deros").write_text(FOREIGN_RULES)
    found = checked(tmp_path / "r.deros", tmp_path / "s.system")
    errors = [each.span.text for each in found if each.is_error]
    assert errors == ["éstop", "élimit", "év", "ée", "éfast", "ésilent", "és", "én"]
    argument = 'argument é : string = "/odom"\n'
    use = SYSTEM.replace("HERE", 'param odom_topic = $é when é != ""')
    (tmp_path / "a.system").write_text(use.replace("topics", f"{argument}topics", 1))
    found = checked(tmp_path / "a.system")
    assert [each.span.text for each in found if each.is_error] == ["é"]
