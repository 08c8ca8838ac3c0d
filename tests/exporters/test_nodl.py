"""Node descriptions as NoDL 2."""

from __future__ import annotations

import math
import tempfile
from dataclasses import replace
from pathlib import Path
from typing import Any

import pytest
import yaml
from hypothesis import example, given, settings
from hypothesis import strategies as st

from deros.diagnostics import SourceFile, Span
from deros.exporters.nodl import file_name, nodl
from deros.interfaces.types import InterfaceType
from deros.metamodels.load import Repository
from deros.models.common import Interval, Name, QosProfile
from deros.models.node import NodeType, Parameter, ParameterType, Port, PortKind
from deros.models.qos import policies
from tests.support.foreign import become

NODE = """\
node base : base_driver "Drives: the base"
parameters
  name rate : double = 10.0 in (0.5, 100.0] "How often"
  name small : double = 1e-12
  name on : bool = true read_only
  name mode : string = "yes" one_of ["yes", "2.0"]
  name joints : string[] = [] max_size 3 unique
  name limits : double[] >= 0.0 size 2 custom "ns::sorted"
publishes
  topic /odom : nav_msgs.Odometry qos best_effort depth 5 deadline 250 ms
  topic hold : std_msgs.Bool qos system_default
services
  service reset : std_srvs.Trigger
clients
  client map : nav_msgs.GetMap qos services depth 3
actions
  action count : example_interfaces.Fibonacci "Counts"
"""

DOCUMENT = """\
nodl_version: 2
description: "Drives: the base"
parameters:
  rate:
    type: double
    default_value: 10.0
    description: "How often"
    validation:
      gt<>: [0.5]
      lt_eq<>: [100.0]
  small:
    type: double
    default_value: 1.0e-12
  "on":
    type: bool
    default_value: true
    read_only: true
  mode:
    type: string
    default_value: "yes"
    validation:
      one_of<>: [["yes", "2.0"]]
  joints:
    type: string_array
    default_value: []
    validation:
      size_lt<>: [4]
      unique<>: []
  limits:
    type: double_array
    validation:
      lower_element_bounds<>: [0.0]
      fixed_size<>: [2]
      "ns::sorted": null
publishers:
  - name: /odom
    type: nav_msgs/msg/Odometry
    qos:
      history: KEEP_LAST
      depth: 5
      reliability: BEST_EFFORT
      durability: VOLATILE
      deadline_ns: 250000000
  - name: hold
    type: std_msgs/msg/Bool
    qos:
      history: SYSTEM_DEFAULT
      reliability: SYSTEM_DEFAULT
      durability: SYSTEM_DEFAULT
service_servers:
  - name: reset
    type: std_srvs/srv/Trigger
service_clients:
  - name: map
    type: nav_msgs/srv/GetMap
    qos:
      history: KEEP_LAST
      depth: 3
      reliability: RELIABLE
      durability: VOLATILE
action_servers:
  - name: count
    type: example_interfaces/action/Fibonacci
    description: Counts
"""


def node(text: str) -> NodeType:
    """Return the node of a description."""
    model = Repository().load_text("base.rnd", text).model
    assert isinstance(model, NodeType)
    return model


def test_a_node_becomes_a_document() -> None:
    """In the order of the schema, with the QoS that each end of a topic has in fact."""
    exported = nodl(node(NODE))
    assert exported.text == DOCUMENT
    assert exported.missing == ()
    assert file_name(node(NODE)) == "base.nodl.yaml"


@pytest.mark.parametrize(
    ("lines", "said"),
    [
        ("lifecycle", "1: 'lifecycle' is not in the document"),
        ('plugin "a::B"', "2: 'plugin a::B' is not in the document"),
        ("parameters open", "1: 'parameters open' is not in the document"),
        ("parameters\n name a : double = 1.0 [m]", "3: parameter 'a' has unit [m]"),
        (
            "parameters\n name a : double[] < 1.0",
            "3: parameter 'a' has range < 1.0; the document has no open ends for lists",
        ),
        (
            "parameters\n name j : string[] = []\n name a.<j>.p : double = 1.0",
            "4: parameter 'a.<j>.p' is not in the document, which has no parameters for entries",
        ),
        ("publishes\n topic _a : std_msgs.Bool", "3: publisher '_a' : std_msgs/msg/Bool is not in"),
        ("publishes\n topic a : nav_msgs.Odometry { pose.pose.position.x [m] }", "has units that"),
        ("publishes\n topic /tf : tf2_msgs.TFMessage { frame a -> b }", "has frames that"),
        ('parameters\n name p : string = "x"\npublishes\n topic a : std_msgs.Bool via p', "'via'"),
        ("subscribes\n topic a : std_msgs.Bool stops after 1 sec", "has 'stops after' that"),
        ("actions\n action a : example_interfaces.Fibonacci qos depth 3", "has QoS that"),
        ("timers\n timer t every 10 ms", "3: timer 't' is not in the document"),
    ],
)
def test_what_a_document_cannot_say_is_listed(lines: str, said: str) -> None:
    """With the line of the description."""
    exported = nodl(node(f"node base : base_driver\n{lines}\n"))
    assert [each.startswith("base.rnd:") and said in each for each in exported.missing] == [True]


SPAN = Span(SourceFile("base.rnd", ""), 0, 0)
NAMES = st.from_regex(r"[a-z][a-z0-9_]{0,8}", fullmatch=True)
TEXTS = st.text(st.characters(exclude_categories=["C", "Z"]), max_size=12)
NUMBERS = st.floats(-1e9, 1e9, allow_nan=False)
ITEMS: dict[str, st.SearchStrategy[Any]] = {
    "bool": st.booleans(),
    "integer": st.integers(-(2**63), 2**63 - 1),
    "double": st.floats(allow_nan=False),
    "string": TEXTS,
    "byte": st.integers(0, 255),
}
DURATIONS = st.none() | st.integers(1, 10**15)
PROFILES = st.builds(
    QosProfile,
    preset=st.sampled_from([None, "sensor_data", "services", "parameters"]),
    reliability=st.sampled_from([None, "reliable", "best_effort"]),
    durability=st.sampled_from([None, "volatile", "transient_local"]),
    depth=st.none() | st.integers(1, 99),
    keep_all=st.booleans(),
    deadline_ns=DURATIONS,
    lifespan_ns=DURATIONS,
    liveliness=st.sampled_from([None, "automatic", "manual_by_topic"]),
    lease_ns=DURATIONS,
)
INTERFACES = {
    PortKind.PUBLISHER: InterfaceType("std_msgs", "msg", "Bool"),
    PortKind.SUBSCRIPTION: InterfaceType("std_msgs", "msg", "Bool"),
    PortKind.SERVICE: InterfaceType("std_srvs", "srv", "Trigger"),
    PortKind.CLIENT: InterfaceType("std_srvs", "srv", "Trigger"),
    PortKind.ACTION: InterfaceType("example_interfaces", "action", "Fibonacci"),
    PortKind.ACTION_CLIENT: InterfaceType("example_interfaces", "action", "Fibonacci"),
}


@st.composite
def parameters(draw: st.DrawFn, name: str) -> Parameter:
    """Draw a parameter that checks clean: its default fits its constraints, or there is none."""
    kind = draw(st.sampled_from(list(ParameterType)))
    item = ITEMS[kind.value.removesuffix("[]")]
    value = st.lists(item, max_size=3).map(tuple) if kind.is_array else item
    plain = Parameter(
        name, kind, draw(st.none() | value), SPAN, SPAN, read_only=draw(st.booleans())
    )
    limits: dict[str, Any] = {"description": " ".join(draw(TEXTS).split())}
    if plain.default is None and kind.value.startswith(("integer", "double")):
        lower, upper = sorted(draw(st.lists(NUMBERS, min_size=2, max_size=2, unique=True)))
        closed = st.just(True) if kind.is_array else st.booleans()
        made = Interval(lower, upper, draw(closed), draw(closed))
        one_sided = [
            replace(made, lower=-math.inf, lower_closed=True),
            replace(made, upper=math.inf, upper_closed=True),
        ]
        limits["interval"] = draw(st.sampled_from([None, made, *one_sided]))
    if plain.default is None and kind.is_array:
        limits["max_size"] = draw(st.none() | st.integers(3, 9))
        limits["min_size"] = draw(st.none() | st.integers(1, 3))
        limits["unique"] = draw(st.booleans())
        limits["custom"] = draw(st.sampled_from([(), (Name("a::b", SPAN),)]))
    if plain.default is None and kind is ParameterType.STRING:
        limits["choices"] = tuple(draw(st.lists(TEXTS, min_size=1, max_size=3, unique=True)))
    return replace(plain, **limits)


@st.composite
def nodes(draw: st.DrawFn) -> NodeType:
    """Draw a node that a document can say all of."""
    ports = []
    for kind, of_type in INTERFACES.items():
        for name in draw(st.lists(NAMES, max_size=2, unique=True)):
            prefix = draw(st.sampled_from(["", "/", "~/"]))
            is_action = kind in (PortKind.ACTION, PortKind.ACTION_CLIENT)
            qos = None if is_action else draw(st.none() | PROFILES)
            text = " ".join(draw(TEXTS).split())
            port = Port(kind, prefix + name, of_type, SPAN, SPAN, SPAN, qos, description=text)
            ports.append(port)
    names = draw(st.lists(NAMES, max_size=3, unique=True))
    return NodeType(
        draw(NAMES),
        "unknown_package",
        SPAN.source,
        SPAN,
        SPAN,
        SPAN,
        description=" ".join(draw(TEXTS).split()),
        parameters=tuple(draw(parameters(each)) for each in names),
        ports=tuple(ports),
    )


@settings(deadline=None, max_examples=80)
@given(nodes())
@example(NodeType("base_", "unknown_package", SPAN.source, SPAN, SPAN, SPAN))
def test_a_document_is_read_as_the_node_that_it_is_of(drawn: NodeType) -> None:
    """Export and import are inverse; ends have the same policies, in other words."""
    exported = nodl(drawn)
    assert exported.missing == ()
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / file_name(drawn)
        path.write_text(exported.text, encoding="utf-8")
        made = become(path)
        assert (made.missing, made.findings) == ((), [])
        read = made.node
    assert (read.name, read.description) == (drawn.name, drawn.description)
    assert read.parameters == drawn.parameters
    assert [replace(each, qos=None) for each in read.ports] == [
        replace(each, qos=None) for each in drawn.ports
    ]
    for port, other in zip(read.ports, drawn.ports, strict=True):
        assert policies(port.qos) == policies(other.qos)


def test_texts_of_any_kind_are_texts_for_yaml() -> None:
    """Words that YAML reads as something else are in quotes, as keys and as values."""
    words = ["yes", "null", "1", "1e3", "~", "", " ", "a: b", "# x", "- a", "é\u2028\x7f", '"\\']
    listed = ", ".join(f'"{each}"' for each in ("yes", "null", "1"))
    lines = f"parameters\n name yes : string[] = [{listed}]\n name null : bool = true\n"
    read = yaml.safe_load(nodl(node(f"node base : base_driver\n{lines}")).text)
    assert read["parameters"] == {
        "yes": {"type": "string_array", "default_value": ["yes", "null", "1"]},
        "null": {"type": "bool", "default_value": True},
    }
    from deros.exporters.yaml_text import yaml_text

    assert yaml.safe_load(yaml_text({"a": words, "b": {}, "c": [{"d": None}]})) == {
        "a": words,
        "b": {},
        "c": [{"d": None}],
    }
