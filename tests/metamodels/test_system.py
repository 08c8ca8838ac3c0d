"""System descriptions: topics, subsystems, nodes and their settings."""

from __future__ import annotations

from pathlib import Path

import pytest

from deros import codes
from deros.diagnostics import Code
from deros.interfaces.types import InterfaceType
from deros.metamodels.load import LoadedFile, Repository
from deros.models.common import QosProfile
from deros.models.node import PortKind
from deros.models.programs import Respawn
from deros.models.system import NodeInstance, Subsystem, System

NODE = """\
node camera : cameras
parameters
  name rate : double
  name gains : double[]
  name label : string
publishes
  topic /image : sensor_msgs.Image
"""


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    """Create a folder with one node description, ``camera.rnd``."""
    (tmp_path / "camera.rnd").write_text(NODE, encoding="utf-8")
    return tmp_path


def _load(folder: Path, body: str) -> LoadedFile:
    text = f'system S imports import "camera.rnd" {body}'
    return Repository().load_text(folder / "s.system", text)


def _system(folder: Path, body: str) -> System:
    loaded = _load(folder, body)
    assert loaded.diagnostics == ()
    assert isinstance(loaded.model, System)
    return loaded.model


def _node(folder: Path, text: str) -> NodeInstance:
    (node,) = _system(folder, f"node n : camera {text}").members
    assert isinstance(node, NodeInstance)
    return node


def test_topic_declarations_are_parsed(folder: Path) -> None:
    """A topic may have a type, a QoS and a description, and be external."""
    plain, pinned, outside = _system(
        folder,
        "topics topic /image topic scan:sensor_msgs.LaserScan qos best_effort depth 5 "
        'external topic /tf : tf2_msgs/TFMessage "From outside"',
    ).topics
    assert (plain.name, plain.type, plain.qos, plain.external) == ("/image", None, None, False)
    assert pinned.type == InterfaceType("sensor_msgs", "msg", "LaserScan")
    assert pinned.qos == QosProfile(reliability="best_effort", depth=5)
    assert pinned.span.text == "topic scan:sensor_msgs.LaserScan qos best_effort depth 5"
    assert outside.external
    assert outside.description == "From outside"
    assert outside.span.text.startswith("external topic /tf")


def test_subsystems_may_be_nested(folder: Path) -> None:
    """Subsystems nest, and have topics, a namespace and a description."""
    outer, node = _system(
        folder,
        'subsystem a namespace /front "The front" '
        "{ topics topic x subsystem b { node m : camera } } node n : camera",
    ).members
    assert isinstance(outer, Subsystem)
    assert (outer.namespace, outer.description) == ("/front", "The front")
    assert [topic.name for topic in outer.topics] == ["x"]
    (inner,) = outer.members
    assert isinstance(inner, Subsystem)
    assert [member.name for member in inner.members] == ["m"]
    assert node.name == "n"


def test_node_attributes_may_have_any_order(folder: Path) -> None:
    """Namespace, respawn, log level, manager and description follow the node type in any order."""
    for text in (
        'namespace /front respawn delay 1.5 sec max 3 log_level debug activated by m "Looks ahead"',
        '"Looks ahead" activated by m log_level debug respawn delay 1500 ms max 3 namespace /front',
    ):
        node = _node(folder, text)
        assert node.namespace == "/front"
        assert node.respawn == Respawn(1_500_000_000, 3)
        assert node.log_level == "debug"
        assert node.activated_by == "m"
        assert node.description == "Looks ahead"
    assert _node(folder, "respawn").respawn == Respawn()
    conditional = _node(folder, "respawn if not quiet and level > 3 delay 1 sec max 2 when quiet")
    behind = _node(folder, "respawn delay 1 sec max 2 if not quiet and level > 3 when quiet")
    assert behind == conditional
    assert conditional.respawn is not None
    assert (conditional.respawn.delay_ns, conditional.respawn.max_restarts) == (1_000_000_000, 2)
    assert conditional.respawn.when is not None
    assert conditional.when is not None
    assert _node(folder, "").respawn is None


def _autostart(found: NodeInstance | Subsystem | System) -> tuple[float, bool]:
    assert found.autostart is not None
    return found.autostart.timeout_s, found.autostart.is_optional


def test_autostart_has_a_timeout_and_what_follows_a_failure(folder: Path) -> None:
    """Both may be left out: ten seconds then, and everything is stopped."""
    for text, meaning in (
        ("autostart", (10.0, False)),
        ("autostart timeout 1500 ms", (1.5, False)),
        ("autostart on failure continue", (10.0, True)),
        ("autostart timeout 2 sec on failure stop log_level warn", (2.0, False)),
    ):
        assert _autostart(_node(folder, text)) == meaning
        (group,) = _system(
            folder, f"subsystem a {text.removesuffix(' log_level warn')} {{ }}"
        ).members
        assert isinstance(group, Subsystem)
        assert _autostart(group) == meaning
    assert _node(folder, "").autostart is None


def test_system_may_have_autostart_on_either_side_of_its_description(folder: Path) -> None:
    """It ends where the parts begin."""
    for head in ('autostart timeout 2 sec "All"', '"All" autostart timeout 2 sec'):
        system = Repository().load_text(folder / "s.system", f"system S {head} node n : x").model
        assert isinstance(system, System)
        assert (system.description, _autostart(system)) == ("All", (2.0, False))


def test_words_of_autostart_are_still_names(folder: Path) -> None:
    """A node, a topic and a subsystem may be called so."""
    system = _system(
        folder,
        "topics topic timeout topic stop subsystem failure autostart { node autostart : camera "
        "autostart wirings connect image to timeout } node continue : camera",
    )
    assert [topic.name for topic in system.topics] == ["timeout", "stop"]
    group, node = system.members
    assert isinstance(group, Subsystem)
    assert (group.name, group.members[0].name, node.name) == ("failure", "autostart", "continue")


@pytest.mark.parametrize(
    ("text", "rate"),
    [("10 Hz", 10.0), ("0.05Hz", 0.05), ("500 mHz", 0.5), ("2 kHz", 2000.0)],
)
def test_topic_may_have_a_rate(folder: Path, text: str, rate: float) -> None:
    """In any unit of rates, among the other words; a topic may be called so."""
    system = _system(folder, f'topics topic rate : a.B rate {text} qos reliable "R" topic other')
    first, second = system.topics
    assert (first.name, first.rate_hz, first.description) == ("rate", rate, "R")
    assert (second.name, second.rate_hz) == ("other", None)


@pytest.mark.parametrize(
    ("text", "code", "message"),
    [
        ("10", codes.UNKNOWN_UNIT, "a rate needs a unit"),
        ("10 ms", codes.UNKNOWN_UNIT, "'ms' is not a unit of rates"),
        ("10 rad/s", codes.UNKNOWN_UNIT, "'rad/s' is not a unit of rates"),
        ("0 Hz", codes.IMPOSSIBLE_NUMBER, "a rate must be positive"),
        ("-1 Hz", codes.IMPOSSIBLE_NUMBER, "a rate must be positive"),
        ("1 Hz rate 2 Hz", codes.DUPLICATE_SECTION, "'rate' is given twice"),
    ],
)
def test_other_rates_are_findings(folder: Path, text: str, code: Code, message: str) -> None:
    """The topic itself is read."""
    loaded = _load(folder, f"topics topic a rate {text}")
    assert [(each.code, each.message) for each in loaded.diagnostics] == [(code, message)]


def test_timeout_of_transitions_is_positive(folder: Path) -> None:
    """No transition is made in no time; without one, the others are read all the same."""
    loaded = _load(folder, "node n : camera autostart timeout 0 sec")
    assert [(each.code, each.message) for each in loaded.diagnostics] == [
        (codes.BAD_DURATION, "the timeout of transitions must be positive")
    ]
    loaded = _load(folder, "node n : camera autostart autostart")
    assert [each.code for each in loaded.diagnostics] == [codes.DUPLICATE_SECTION]


def test_settings_and_wirings_are_parsed(folder: Path) -> None:
    """Values keep their type; whole numbers become doubles where the parameter is a double."""
    node = _node(
        folder,
        "wirings connect /image to ~/image; connect image to pictures "
        "parameters param rate = 5 param gains = [1, 2.5] "
        'param label = "x" param other.part = true',
    )
    assert [(s.name, s.value) for s in node.parameters] == [
        ("rate", 5.0),
        ("gains", (1.0, 2.5)),
        ("label", "x"),
        ("other.part", True),
    ]
    assert isinstance(node.parameters[0].value, float)
    assert [(w.port, w.target) for w in node.wirings] == [
        ("/image", "~/image"),
        ("image", "pictures"),
    ]


def test_spans_cover_exactly_their_words(folder: Path) -> None:
    """The spans of ports, targets, values and types are exactly their words."""
    node = _node(folder, "parameters param gains = [1, 2] wirings connect /image to /x")
    (setting,) = node.parameters
    (wiring,) = node.wirings
    assert (setting.name_span.text, setting.value_span.text) == ("gains", "[1, 2]")
    assert (wiring.port_span.text, wiring.target_span.text) == ("/image", "/x")
    assert wiring.span.text == "connect /image to /x"
    assert (node.name_span.text, node.type_span.text) == ("n", "camera")


def test_keywords_are_valid_names_where_unambiguous(folder: Path) -> None:
    """Nodes, subsystems, parameters and ports may have names that are keywords."""
    (subsystem,) = _system(
        folder,
        "subsystem topics { node node : camera parameters param param = 1 param topic = 2 "
        "wirings connect to to to connect connect to topic }",
    ).members
    assert isinstance(subsystem, Subsystem)
    (node,) = subsystem.members
    assert isinstance(node, NodeInstance)
    assert [s.name for s in node.parameters] == ["param", "topic"]
    assert [(w.port, w.target) for w in node.wirings] == [("to", "to"), ("connect", "topic")]


def test_keywords_are_whole_words(folder: Path) -> None:
    """``nodefoo`` is not ``node foo``."""
    (finding,) = _load(folder, "nodefoo : camera").diagnostics
    assert (finding.code, finding.span.text) == (codes.SYNTAX_ERROR, "nodefoo")


@pytest.mark.parametrize(
    ("body", "code", "text"),
    [
        ("topics topic /a topics topic /b", codes.DUPLICATE_SECTION, "topics"),
        ("imports", codes.DUPLICATE_SECTION, "imports"),
        ("node n : camera parameters parameters", codes.DUPLICATE_SECTION, "parameters"),
        ("node n : camera wirings wirings", codes.DUPLICATE_SECTION, "wirings"),
        ("node n : camera respawn respawn", codes.DUPLICATE_SECTION, "respawn"),
        ("node n : camera respawn delay 1", codes.UNKNOWN_UNIT, "1"),
        ("subsystem s : S { topics }", codes.UNKNOWN_SYSTEM, "S"),
    ],
)
def test_duplicates_and_undefined_names_are_findings(
    folder: Path, body: str, code: Code, text: str
) -> None:
    """Duplicate sections and undefined names are reported at their place."""
    finding = _load(folder, body).diagnostics[0]
    assert (finding.code, finding.span.text) == (code, text)


def test_imported_subsystem_cannot_have_a_body(tmp_path: Path) -> None:
    """``subsystem a : Arm { … }`` is contradictory."""
    (tmp_path / "arm.system").write_text("system Arm", encoding="utf-8")
    text = 'system S imports import "arm.system" subsystem a : Arm { topics topic /x }'
    (finding,) = Repository().load_text(tmp_path / "s.system", text).diagnostics
    assert (finding.code, finding.span.text) == (codes.SYNTAX_ERROR, "a")


@pytest.mark.parametrize(
    ("text", "kind", "port", "target"),
    [
        ("publisher image to /x", PortKind.PUBLISHER, "image", "/x"),
        ("subscriber /image to ~/x", PortKind.SUBSCRIPTION, "/image", "~/x"),
        ("service a to b", PortKind.SERVICE, "a", "b"),
        ("client\n/* c */ a // d\n to b", PortKind.CLIENT, "a", "b"),
        ("action a to b", PortKind.ACTION, "a", "b"),
        ("action_client a to b", PortKind.ACTION_CLIENT, "a", "b"),
        ('publisher "image" to /x', PortKind.PUBLISHER, "image", "/x"),
        ("publisher publisher to /x", PortKind.PUBLISHER, "publisher", "/x"),
        ("publisher to /x", None, "publisher", "/x"),
        ("action to action", None, "action", "action"),
        ("client to to", None, "client", "to"),
        ("publisher/image to /x", None, "publisher/image", "/x"),
        ("mode.topic to /x", None, "mode.topic", "/x"),
        ('"3d.topic" to /x', None, "3d.topic", "/x"),
    ],
)
def test_port_kind_before_a_port_name(
    folder: Path, text: str, kind: PortKind | None, port: str, target: str
) -> None:
    """A port may have the name of a kind, and names may be quoted."""
    (wiring,) = _node(folder, f"wirings connect {text}").wirings
    assert (wiring.kind, wiring.port, wiring.target) == (kind, port, target)


def test_settings_of_any_parameter_name_and_number(folder: Path) -> None:
    """A system may set any parameter that a description can name, also to NaN."""
    node = _node(
        folder,
        "parameters param qos_overrides./tf.publisher.depth = 3 param a-b = [nan, -inf]"
        ' param "3d" = inf param rate = nan',
    )
    assert [(parameter.name, repr(parameter.value)) for parameter in node.parameters] == [
        ("qos_overrides./tf.publisher.depth", "3"),
        ("a-b", "(nan, -inf)"),
        ("3d", "inf"),
        ("rate", "nan"),
    ]
