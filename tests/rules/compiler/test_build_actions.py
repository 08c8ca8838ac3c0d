"""Actions: published values, and constant arguments of other actions."""

from __future__ import annotations

import itertools

import pytest

from deros.interfaces.types import InterfaceType
from deros.rules.program import ir
from tests.support.rules import build_rules, program


def binding(text: str, declarations: str = "") -> ir.Binding:
    """Return the message that an action publishes."""
    built = program(f"{declarations}\naction act publishes {text};").actions[0].binding
    assert built is not None
    return built


@pytest.mark.parametrize(
    ("text", "path", "value"),
    [
        ("true on /stop : std_msgs.Bool", ("data",), True),
        ("false on /stop : std_msgs.Bool", ("data",), False),
        ("2 on /mode : std_msgs.UInt8", ("data",), 2),
        ("2 on /speed : std_msgs.Float64", ("data",), 2.0),
        ("slow on /speed : std_msgs.Float64", ("data",), 0.5),
        ('"halt" on /name : std_msgs.String', ("data",), "halt"),
        ("ERROR on /status : diagnostic_msgs.DiagnosticStatus", ("level",), 2),
        ('"bad" on /status : diagnostic_msgs.DiagnosticStatus', ("name",), "bad"),
        ("40 cm on /far : sensor_msgs.Range", ("min_range",), 0.4000000059604645),
        ("2 on /far : sensor_msgs.Range", ("radiation_type",), 2),
        ("30 deg on /far : sensor_msgs.Range", ("field_of_view",), 0.5235987901687622),
    ],
)
def test_value_goes_into_the_first_matching_field(
    text: str, path: tuple[str, ...], value: ir.Scalar
) -> None:
    """The first primitive field of matching kind, range and unit gets it, in its own type."""
    bound = binding(text, "const slow = 0.5 m/s")
    assert (bound.path, bound.value) == (path, value)
    assert type(bound.value) is type(value)


def test_binding_has_topic_and_type() -> None:
    """A relative topic is put under the root."""
    assert binding("true on stop : std_msgs.Bool") == ir.Binding(
        "/stop", InterfaceType("std_msgs", "msg", "Bool"), ("data",), True
    )


def test_indistinguishable_active_state_is_a_warning() -> None:
    """Publishing the default of the field makes active and inactive look the same."""
    result = build_rules("action slow publishes 0 on /mode : std_msgs.UInt8;")
    assert [diagnostic.code.name for diagnostic in result.diagnostics] == ["DRS333"]
    assert result.program is not None


def test_actions_may_have_a_reset_or_a_latch() -> None:
    """A reset is the index of another action, declared before or after."""
    built = program(
        """
        action stop publishes true on /stop : std_msgs.Bool reset_by ok;
        action halt publishes true on /stop : std_msgs.Bool latched;
        action ok;
        """
    )
    assert [(action.reset_by, action.latched) for action in built.actions] == [
        (2, False),
        (None, True),
        (None, False),
    ]


def test_arguments_keep_their_types() -> None:
    """An integer stays one; a converted constant has the target unit."""
    built = program(
        """
        action beep(a, b, c, d, f);
        const half = toRad(180 deg)
        entity e { r: topic /flag.data; }
        if e.r then { beep(3, 3.0, half, true, "x"); };
        """
    )
    trigger = built.behaviours[0].body[0]
    assert isinstance(trigger, ir.Trigger)
    assert trigger.arguments == (3, 3.0, 3.141592653589793, True, "x")
    assert [type(argument) for argument in trigger.arguments] == [int, float, float, bool, str]
    assert built.actions[0].parameters == ("a", "b", "c", "d", "f")


@pytest.mark.parametrize(
    ("text", "field", "value"),
    [
        ("true on /arm : std_srvs.SetBool", "data", True),
        ("off on /arm : std_srvs.SetBool", "data", False),
        ("/halt : std_srvs.Trigger", None, None),
        ("halt : std_srvs.Trigger", None, None),
    ],
)
def test_service_has_the_value_in_the_field_of_its_request(
    text: str, field: str | None, value: ir.Scalar | None
) -> None:
    """An empty request has none; a relative service is put under the root."""
    (action,) = program(f"const off = false action act calls {text} latched;").actions
    call = action.service
    assert call is not None
    assert (call.field, call.value) == (field, value)
    assert call.service in ("/arm", "/halt")
    assert call.type.kind == "srv"
    assert action.is_bound
    assert action.binding is None


def test_action_may_publish_and_call() -> None:
    """In any order, with the other attributes between them."""
    texts = ("publishes true on /stop : std_msgs.Bool", "latched", "calls /halt : std_srvs.Trigger")
    for first, second, third in itertools.permutations(texts):
        (action,) = program(f"action act {first} {second} {third};").actions
        assert action.binding == binding("true on /stop : std_msgs.Bool")
        assert action.service is not None
        assert action.latched


def test_gate_does_not_see_a_service() -> None:
    """The hint says how it can."""
    result = build_rules(
        "action halt calls /halt : std_srvs.Trigger latched;"
        "gate /a -> /speed : std_msgs.Float64 rate 20 Hz { halt: silence; }"
    )
    (finding,) = (each for each in result.diagnostics if each.code.name == "DRS338")
    assert finding.hint == (
        "let it publish its state too: write 'publishes true on /halt : std_msgs.Bool' before"
        " 'calls …'"
    )
