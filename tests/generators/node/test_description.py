"""Printing of node descriptions."""

from __future__ import annotations

from typing import Any

from hypothesis import given
from hypothesis import strategies as st

from deros.diagnostics import SourceFile, Span
from deros.generators.node.description import node_description
from deros.interfaces.types import InterfaceType
from deros.metamodels.load import Repository
from deros.models.common import Interval, Name, QosProfile
from deros.models.node import (
    FieldUnit,
    Frame,
    FrameName,
    NodeType,
    Parameter,
    ParameterType,
    Port,
    PortKind,
    Timer,
)

NOWHERE = SourceFile("nowhere.rnd", "")
SPAN = Span(NOWHERE, 0, 0)

names = st.from_regex(r"[a-z][a-z0-9_]{0,8}", fullmatch=True)
graph_names = st.builds("".join, st.tuples(st.sampled_from(["", "/", "~/"]), names))
texts = st.text(st.characters(exclude_categories=["Cc", "Cf", "Cs", "Zl", "Zp"]), max_size=12)
durations = st.integers(1, 10**12)
numbers = st.floats(allow_nan=False, allow_infinity=False)
scalars = {
    ParameterType.BOOL: st.booleans(),
    ParameterType.INTEGER: st.integers(-(2**63), 2**63 - 1),
    ParameterType.DOUBLE: numbers,
    ParameterType.STRING: texts,
}
arrays = {
    ParameterType.BYTE_ARRAY: st.integers(0, 255),
    ParameterType.BOOL_ARRAY: scalars[ParameterType.BOOL],
    ParameterType.INTEGER_ARRAY: scalars[ParameterType.INTEGER],
    ParameterType.DOUBLE_ARRAY: scalars[ParameterType.DOUBLE],
    ParameterType.STRING_ARRAY: scalars[ParameterType.STRING],
}
values: dict[ParameterType, st.SearchStrategy[Any]] = scalars | {
    kind: st.lists(item, max_size=3).map(tuple) for kind, item in arrays.items()
}
intervals = st.builds(Interval, numbers, numbers, st.booleans(), st.booleans())
profiles = st.builds(
    QosProfile,
    preset=st.sampled_from([None, "sensor_data", "services", "parameters", "system_default"]),
    reliability=st.sampled_from([None, "reliable", "best_effort"]),
    durability=st.sampled_from([None, "volatile", "transient_local"]),
    depth=st.none() | st.integers(1, 99),
    keep_all=st.booleans(),
    deadline_ns=st.none() | durations,
    lifespan_ns=st.none() | durations,
).filter(lambda profile: profile != QosProfile())

frame_names = st.builds(
    FrameName, st.sampled_from(["odom", "/base_link", "<a.b>", "r2.<a>/base-link"]), st.just(SPAN)
)
switches = st.builds(Name, st.sampled_from(["on", "a//b", "base.publish_tf"]), st.just(SPAN))
frames = st.builds(Frame, frame_names, frame_names, st.none() | switches)


@st.composite
def parameters(draw: st.DrawFn) -> Parameter:
    """Draw a parameter with a default of its type."""
    kind = draw(st.sampled_from(list(values)))
    return Parameter(
        draw(names),
        kind,
        draw(st.none() | values[kind]),
        SPAN,
        SPAN,
        unit=draw(st.sampled_from([None, "m", "m/s", "1/s"])),
        interval=draw(st.none() | intervals),
        choices=draw(st.none() | st.lists(values[kind], max_size=2).map(tuple))
        if not kind.is_array
        else None,
        size=draw(st.none() | st.integers(0, 9)),
        read_only=draw(st.booleans()),
        description=draw(texts),
    )


@st.composite
def nodes(draw: st.DrawFn) -> NodeType:
    """Draw a node with ports sorted by kind, as in sections."""
    ports: list[Port] = []
    for kind in draw(st.permutations(list(PortKind))):
        section = {"services": "srv", "clients": "srv", "actions": "action"}.get(kind.value, "msg")
        section = "action" if kind is PortKind.ACTION_CLIENT else section
        units = st.lists(
            st.builds(
                FieldUnit,
                st.sampled_from(["x", "a.b[2].c"]),
                st.just("m/s"),
                st.just(SPAN),
                st.just(SPAN),
            ),
            max_size=2,
        )
        port = st.builds(
            Port,
            st.just(kind),
            graph_names,
            st.builds(InterfaceType, names, st.just(section), names.map(str.title)),
            st.just(SPAN),
            st.just(SPAN),
            st.just(SPAN),
            qos=st.none() | profiles,
            via=st.none() | names,
            units=units.map(tuple),
            frames=st.lists(frames, max_size=2).map(tuple),
            stops_after_ns=(
                st.none() | durations.filter(bool) if kind is PortKind.SUBSCRIPTION else st.none()
            ),
            description=texts,
        )
        ports += draw(st.lists(port, max_size=2))
    return NodeType(
        draw(names),
        draw(names),
        NOWHERE,
        SPAN,
        SPAN,
        SPAN,
        description=draw(texts),
        executable=draw(st.none() | texts),
        lifecycle=draw(st.booleans()),
        parameters=tuple(draw(st.lists(parameters(), max_size=3))),
        ports=tuple(ports),
        timers=tuple(
            draw(
                st.lists(
                    st.builds(Timer, names, durations, st.just(SPAN), st.just(SPAN), texts),
                    max_size=2,
                )
            )
        ),
    )


@given(nodes())
def test_printed_description_parses_to_the_same_model(node: NodeType) -> None:
    """The loader is the inverse of the printer, for every construct of the language."""
    text = node_description(node)
    loaded = Repository().load_text("printed.rnd", text)
    assert loaded.diagnostics == ()
    assert loaded.model == node


def test_description_has_the_layout_of_the_paper() -> None:
    """Sections at the margin, one entry per line below them."""
    text = (
        'node robot_safety_node : robot_safety "Watches the robot"\n'
        "parameters\n"
        "  name publish_freq : double = 10.0 [Hz] in [0.001, 1000.0] read_only\n"
        "subscribes\n"
        "  topic /imu : sensor_msgs.Imu qos best_effort depth 10\n"
        "services\n"
        "  service ~/reset : std_srvs.Trigger\n"
    )
    model = Repository().load_text("robot.rnd", text).model
    assert isinstance(model, NodeType)
    assert node_description(model) == text
