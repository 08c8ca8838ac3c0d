"""Node descriptions: every extension, and attributes that may be given only once."""

from __future__ import annotations

import math

import pytest

from deros import codes
from deros.diagnostics import Code
from deros.interfaces.types import InterfaceType
from deros.metamodels.imported_part import NOTICE
from deros.metamodels.load import Repository
from deros.models.common import Interval, QosProfile
from deros.models.node import NodeType, Parameter, ParameterType, Port, PortKind


def _node(body: str) -> NodeType:
    loaded = Repository().load_text("a.rnd", f"node a : p {body}")
    assert loaded.diagnostics == ()
    assert isinstance(loaded.model, NodeType)
    return loaded.model


def _parameter(text: str) -> Parameter:
    (parameter,) = _node(f"parameters name x : {text}").parameters
    return parameter


def _port(text: str, section: str = "publishes") -> Port:
    (port,) = _node(f"{section} {text}").ports
    return port


def _findings(body: str) -> list[tuple[Code, str]]:
    loaded = Repository().load_text("a.rnd", f"node a : p {body}")
    return [(finding.code, finding.span.text) for finding in loaded.diagnostics]


def test_node_header_has_description_executable_and_lifecycle() -> None:
    """Description, executable and lifecycle follow the package."""
    node = _node('"Turns ticks into odometry" executable "odometry" lifecycle')
    assert node.description == "Turns ticks into odometry"
    assert node.executable_name == "odometry"
    assert node.lifecycle


def test_executable_defaults_to_the_node_name() -> None:
    """Without ``executable`` the program has the name of the node."""
    assert _node("").executable is None
    assert _node("").executable_name == "a"


@pytest.mark.parametrize(
    ("text", "kind", "default"),
    [
        ("bool = true", ParameterType.BOOL, True),
        ("int = -3", ParameterType.INTEGER, -3),
        ("integer = 3", ParameterType.INTEGER, 3),
        ("double = 3", ParameterType.DOUBLE, 3.0),
        ("float = 1e-3", ParameterType.DOUBLE, 0.001),
        (r'string = "a\"b\\c\nd\u00e9"', ParameterType.STRING, 'a"b\\c\ndé'),
        ("byte[] = [1, 2]", ParameterType.BYTE_ARRAY, (1, 2)),
        ("bool[] = [true, false]", ParameterType.BOOL_ARRAY, (True, False)),
        ("int[] = []", ParameterType.INTEGER_ARRAY, ()),
        ("double [ ] = [1.0, 2]", ParameterType.DOUBLE_ARRAY, (1.0, 2.0)),
        ('string[] = ["a", "b"]', ParameterType.STRING_ARRAY, ("a", "b")),
        ("double", ParameterType.DOUBLE, None),
    ],
)
def test_parameters_have_types_and_defaults(
    text: str, kind: ParameterType, default: object
) -> None:
    """Every ROS 2 type is read; a whole number for a double becomes one."""
    parameter = _parameter(text)
    assert parameter.type is kind
    assert parameter.default == default
    assert type(parameter.default) is type(default)


def test_parameter_attributes_may_have_any_order() -> None:
    """Unit, bounds, description and read_only may follow the default in any order."""
    for text in (
        'double = 0.52 [m] in [0.1, 2.0) "Distance" read_only',
        'double = 0.52 read_only "Distance" in [0.1, 2.0) [m]',
    ):
        parameter = _parameter(text)
        assert parameter.unit == "m"
        assert parameter.interval == Interval(0.1, 2.0, True, False)
        assert parameter.description == "Distance"
        assert parameter.read_only


def test_parameter_may_have_choices_or_a_size() -> None:
    """``one_of`` lists values, ``size`` gives the length of an array."""
    assert _parameter('string = "a" one_of ["a", "b"]').choices == ("a", "b")
    assert _parameter("double = 1 one_of [1, 2.5]").choices == (1.0, 2.5)
    assert _parameter("double[] = [1.0] size 1").size == 1


@pytest.mark.parametrize("spelling", ["std_msgs.Bool", "std_msgs/Bool", "std_msgs/msg/Bool"])
def test_interface_type_has_three_spellings(spelling: str) -> None:
    """All three spellings are one type."""
    assert _port(f"topic x : {spelling}").type == InterfaceType("std_msgs", "msg", "Bool")


@pytest.mark.parametrize(
    ("section", "keyword", "kind", "interface"),
    [
        ("publishes", "topic", PortKind.PUBLISHER, "msg"),
        ("subscribes", "topic", PortKind.SUBSCRIPTION, "msg"),
        ("services", "service", PortKind.SERVICE, "srv"),
        ("clients", "client", PortKind.CLIENT, "srv"),
        ("actions", "action", PortKind.ACTION, "action"),
        ("action_clients", "action", PortKind.ACTION_CLIENT, "action"),
    ],
)
def test_sections_determine_kinds_of_ports(
    section: str, keyword: str, kind: PortKind, interface: str
) -> None:
    """Each section has its kind of port and of type."""
    port = _port(f"{keyword} ~/x : a_b.C", section)
    assert (port.kind, port.name, port.type.kind) == (kind, "~/x", interface)


def test_qos_policies_are_parsed() -> None:
    """Every QoS keyword is read, durations as nanoseconds."""
    port = _port(
        "topic x : a.B qos best_effort transient_local depth 5 deadline 100 ms "
        "lifespan 0.5sec liveliness manual_by_topic lease 2 s"
    )
    assert port.qos == QosProfile(
        reliability="best_effort",
        durability="transient_local",
        depth=5,
        deadline_ns=100_000_000,
        lifespan_ns=500_000_000,
        liveliness="manual_by_topic",
        lease_ns=2_000_000_000,
    )
    assert _port("topic x : a.B qos sensor_data").qos == QosProfile(preset="sensor_data")
    assert _port("topic x : a.B qos reliable volatile keep_all").qos == QosProfile(
        reliability="reliable", durability="volatile", keep_all=True
    )


def test_qos_presets_may_have_names_of_sections() -> None:
    """``services`` and ``parameters`` are presets after ``qos``, unless they open a section."""
    node = _node("publishes topic x : a.B qos services parameters name y : int")
    assert node.ports[0].qos == QosProfile(preset="services")
    assert [p.name for p in node.parameters] == ["y"]
    node = _node("publishes topic x : a.B qos reliable services service y : a.C")
    assert node.ports[0].qos == QosProfile(reliability="reliable")
    assert [p.name for p in node.ports] == ["x", "y"]
    node = _node("services service x : a.B qos services service y : a.C qos services depth 1")
    assert [p.qos and p.qos.preset for p in node.ports] == ["services", "services"]


def test_port_may_have_field_units_and_a_topic_parameter() -> None:
    """Units of fields are in braces; ``via`` names the parameter with the topic name."""
    port = _port(
        "topic odom : nav_msgs.Odometry { twist.twist.linear.x [m/s], position[2] [ rad ] } "
        'via odom_topic "Where we are"'
    )
    assert [(u.path, u.unit) for u in port.units] == [
        ("twist.twist.linear.x", "m/s"),
        ("position[2]", "rad"),
    ]
    assert (port.via, port.description) == ("odom_topic", "Where we are")


def test_silence_of_a_subscription_may_stop_the_node() -> None:
    """Other attributes may stand before and after it."""
    node = _node(
        'subscribes topic a : x.A qos depth 1 stops after 0.5 sec "Drive" topic b : x.A'
        " stops after 3 ns via c"
    )
    assert [port.stops_after_ns for port in node.ports] == [500_000_000, 3]


def test_port_may_have_frames_whose_names_come_from_parameters() -> None:
    """Frames are in braces, parent first; ``<x>`` stands for a parameter, ``if`` switches."""
    port = _port(
        "topic /tf : tf2_msgs.TFMessage { frame odom->base-link if base.publish_tf, "
        "frame /base_link -> <prefix>camera/<name> } qos depth 100"
    )
    first, second = port.frames
    assert (first.parent.text, first.child.text, str(first.switch)) == (
        "odom",
        "base-link",
        "base.publish_tf",
    )
    assert (second.parent.text, second.child.parameters) == ("/base_link", ("prefix", "name"))
    assert second.switch is None
    assert second.child.filled_in({"prefix": "/left_", "name": "x"}) == "left_camera/x"
    assert second.child.filled_in({"prefix": "left_", "name": None}) is None


def test_timer_period_is_in_nanoseconds() -> None:
    """The period of a timer is in whole nanoseconds."""
    (timer,) = _node('timers timer control every 20 ms "The control loop"').timers
    assert (timer.name, timer.period_ns, timer.description) == (
        "control",
        20_000_000,
        "The control loop",
    )


def test_keywords_are_valid_names_where_unambiguous() -> None:
    """Parameters, topics and timers may have names that are keywords."""
    node = _node(
        "parameters name name : int name topic : int name parameters : int "
        "name in : int = 1 in [0, 2] "
        "publishes topic topic : a.B topic publishes : a.B "
        "timers timer every every 1 sec timer timer every 2 sec"
    )
    assert [p.name for p in node.parameters] == ["name", "topic", "parameters", "in"]
    assert [p.name for p in node.ports] == ["topic", "publishes"]
    assert [t.name for t in node.timers] == ["every", "timer"]


def test_layout_is_free_and_semicolons_are_optional() -> None:
    """The same node on one line or many, with or without ``;``."""
    one = "parameters name x:int=3;name y:bool publishes topic z:a.B;topic w:a.B;"
    many = (
        "parameters\n name x\n :\n int = 3\n name y : bool\npublishes topic z : a.B\ntopic w : a.B"
    )
    assert _node(one) == _node(many)


def test_spans_cover_exactly_their_words() -> None:
    """The spans of names, types, defaults and units are exactly their words."""
    node = _node("parameters name x : double = 0.5 [m/s] publishes topic /t : a.B via x")
    (parameter,) = node.parameters
    (port,) = node.ports
    assert parameter.name_span.text == "x"
    assert parameter.default_span is not None
    assert parameter.default_span.text == "0.5"
    assert parameter.unit_span is not None
    assert parameter.unit_span.text == "m/s"
    assert parameter.span.text == "name x : double = 0.5 [m/s]"
    assert (port.name_span.text, port.type_span.text) == ("/t", "a.B")
    assert (node.name_span.text, node.package_span.text) == ("a", "p")


@pytest.mark.parametrize(
    ("body", "code", "text"),
    [
        ("parameters name x : int parameters name y : int", codes.DUPLICATE_SECTION, "parameters"),
        ("lifecycle lifecycle", codes.DUPLICATE_SECTION, "lifecycle"),
        ("publishes topic x : a.B via c via d", codes.DUPLICATE_SECTION, "via d"),
        ("publishes topic x : a.B stops after 1 ms", codes.SYNTAX_ERROR, "stops after 1 ms"),
        (
            "publishes topic x : a.B { frame a -> b } { frame c -> d }",
            codes.DUPLICATE_SECTION,
            "{ frame c -> d }",
        ),
        ("parameters name x : int [m] [s]", codes.DUPLICATE_SECTION, "[s]"),
        ("publishes topic x : a.B qos depth 1 depth 2", codes.DUPLICATE_SECTION, "depth 2"),
        ("timers timer t every 20", codes.UNKNOWN_UNIT, "20"),
        ("timers timer t every 20 parsec", codes.UNKNOWN_UNIT, "parsec"),
        ("timers timer t every 20 m", codes.UNKNOWN_UNIT, "m"),
        ("timers timer t every -20 ms", codes.BAD_DURATION, "-20 ms"),
        ("timers timer t every 0.5 ns", codes.BAD_DURATION, "0.5 ns"),
        ("timers timer t every 0 ms", codes.BAD_DURATION, "0 ms"),
    ],
)
def test_duplicates_and_invalid_durations_are_findings(body: str, code: Code, text: str) -> None:
    """Duplicate attributes and invalid durations are reported at their place."""
    assert _findings(body) == [(code, text)]


def test_own_and_imported_part_may_have_a_section_each() -> None:
    """The line between them shows both; within a part, one is easily overlooked."""
    section = "publishes topic {} : a.B\n"
    above, below = (section.format(each) for each in "xy")
    assert _findings(f"{above}\n{NOTICE}\n// digest: 0\n\n{below}") == []
    for text in (
        f"{above}{above}\n{NOTICE}\n{below}",
        f"{above}\n{NOTICE}\n{below}{below}",
        f"{above} {NOTICE}\n{below}",  # that is a comment like any other
    ):
        assert [code for code, _ in _findings(text)] == [codes.DUPLICATE_SECTION]


def test_repeated_section_is_kept() -> None:
    """The content of a repeated section is kept, so that nothing else appears to be missing."""
    loaded = Repository().load_text(
        "a.rnd", "node a : p parameters name x : int parameters name y : int"
    )
    assert isinstance(loaded.model, NodeType)
    assert [p.name for p in loaded.model.parameters] == ["x", "y"]


@pytest.mark.parametrize(
    ("text", "name"),
    [
        ("a.b", "a.b"),
        ("qos_overrides./tf.publisher.depth", "qos_overrides./tf.publisher.depth"),
        ("max-age", "max-age"),
        ("/x", "/x"),
        ('"3d"', "3d"),
        ('"a//b"', "a//b"),
        ("gains.<joints>.p", "gains.<joints>.p"),
        ("<joints>", "<joints>"),
    ],
)
def test_special_parameter_names_are_quoted(text: str, name: str) -> None:
    """Quotes are needed where the name would be read as a comment or a number."""
    node = _node(f"parameters name {text} : double publishes topic t : std_msgs.Bool via {text}")
    assert [parameter.name for parameter in node.parameters] == [name]
    assert [port.via for port in node.ports] == [name]


@pytest.mark.parametrize(
    ("text", "lower", "upper", "lower_closed", "upper_closed"),
    [
        (">= 0", 0, math.inf, True, True),
        ("> 0", 0, math.inf, False, True),
        ("<= -1.5", -math.inf, -1.5, True, True),
        ("< 1e3", -math.inf, 1000, True, False),
        ("> 0 [m] < 2 read_only", 0, 2, False, False),
        ("< 2 > 0", 0, 2, False, False),
    ],
)
def test_parameter_bounds_may_be_one_sided(
    text: str, lower: float, upper: float, lower_closed: bool, upper_closed: bool
) -> None:
    """A bound on one side leaves the other unbounded; two make a range."""
    parameter = _parameter(f"double = 0.5 {text}")
    assert parameter.interval == Interval(lower, upper, lower_closed, upper_closed)
    assert parameter.default == 0.5


def test_second_bound_on_one_side_is_a_finding() -> None:
    """A range bounds both sides."""
    for text in ("> 0 >= 1", "in [0, 1] < 5", "< 5 in [0, 1]"):
        ((code, _),) = _findings(f"parameters name x : double {text}")
        assert code is codes.DUPLICATE_SECTION


def test_parameters_may_have_sizes_and_element_constraints() -> None:
    """Sizes, uniqueness and custom functions are read, the latter with their places."""
    text = 'not_empty unique min_size 1 max_size 3 custom "a::b" custom "c::d::e" "The joints"'
    parameter = _parameter(f'string[] = ["x"] {text}')
    assert (parameter.min_size, parameter.max_size, parameter.size) == (1, 3, None)
    assert parameter.not_empty
    assert parameter.unique
    assert [(each.text, each.span.text) for each in parameter.custom] == [
        ("a::b", '"a::b"'),
        ("c::d::e", '"c::d::e"'),
    ]
    assert parameter.description == "The joints"


@pytest.mark.parametrize("text", ["nan", "inf", "-inf", "+inf"])
def test_doubles_may_be_nan_or_infinite(text: str) -> None:
    """They are written as in Python and C++, alone or in arrays."""
    assert repr(_parameter(f"double = {text}").default) == repr(float(text))
    assert repr(_parameter(f"double[] = [{text}, 1]").default) == repr((float(text), 1.0))
    assert [
        name for _, name in _findings("parameters name nan : double = inf name inf : int")
    ] == []


def test_one_name_for_ports_of_all_kinds() -> None:
    """A wiring applies to all kinds or to one; an exact name takes precedence."""
    node = _node(
        "publishes topic /x : std_msgs.Bool topic y : std_msgs.Bool subscribes topic x :"
        " std_msgs.Bool topic /y : std_msgs.Bool services service z : std_srvs.Trigger"
        " clients client z : std_srvs.Trigger"
    )
    assert [port.kind.word for port in node.ports_named("z")] == ["service", "client"]
    assert [port.name for port in node.ports_named("x")] == ["x"]
    assert [port.name for port in node.ports_named("x", PortKind.PUBLISHER)] == ["/x"]
    assert node.ports_named("z", PortKind.PUBLISHER) == ()


def test_map_parameters_have_names_and_keys() -> None:
    """A parameter has a name for each map key, and finds the key of a name."""
    node = _node("parameters name joints : string[] name gains.<joints>.p : double")
    gains = node.parameters[1]
    assert gains.keys == ("joints",)
    assert gains.name_for("elbow") == "gains.elbow.p"
    assert gains.entry_of("gains.left.elbow.p") == "left.elbow"
    assert [gains.entry_of(name) for name in ("gains.p", "gains..p", "x.a.p")] == [None] * 3
    assert node.parameter_for("gains.a.p") is gains
    assert node.parameter_for("gains.a.i") is None
