"""Requirements that others have published can be written as rules, and are violated when they are.

Sources, both in the repository NASA-SW-VnV/fret: the ten cyber-physical challenge problems of
Lockheed Martin (``caseStudies/LMCPS/LM_requirements.json``) and the lift-plus-cruise aircraft
(``caseStudies/LiftPlusCruise/LPC_full_reqts_and_vars.json``). A requirement is named as there. Its
rule says that it is violated. Where the source counts ticks, a message comes every 10 ms here.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from math import cos, sin
from pathlib import Path

import pytest

from deros.interfaces.store import InterfaceStore
from deros.metamodels.load import Repository
from deros.models.rules import Rules
from deros.rules.compiler.build import build
from deros.rules.engine.engine import Engine
from deros.rules.program.ir import Program

TICK_NS = 10_000_000
BOOLEANS = ("altitude_hold", "autopilot", "limits", "standby", "apfail", "supported", "pullup")
ATTITUDE = {"phi": 0.1, "theta": 0.2, "psi": 0.3}
PHI, THETA, PSI = ATTITUDE.values()
TRIPLE = {"ia": 1.0, "ib": 2.0, "ic": 4.0}


@dataclass(frozen=True)
class Requirement:
    """A requirement.

    Attributes:
        name: in its source.
        violation: when it is violated, as a rule; its names are fields of one message.
        kept: the values of a message that keeps it.
        broken: what is different in a message that violates it.
        before: how often the first message comes before the second one.
        repeated: how often the second message comes; the last one violates it.
    """

    name: str
    violation: str
    kept: Mapping[str, float]
    broken: Mapping[str, float] = field(default_factory=dict)
    before: int = 2
    repeated: int = 1


def _equal(left: str, right: str) -> str:
    """Return that two numbers differ by more than their last digits."""
    return f"abs({left} - ({right})) > 1e-9"


def _off(name: str, value: float) -> tuple[dict[str, float], dict[str, float]]:
    return {**ATTITUDE, name: value}, {name: value + 1e-6}


REQUIREMENTS = [
    # Euler transformation: the matrix of an attitude, and the vectors that it turns.
    Requirement(
        "EUL-001A", _equal("c", "cos(theta) * cos(psi)"), *_off("c", cos(THETA) * cos(PSI))
    ),
    Requirement(
        "EUL-001B", _equal("c", "cos(theta) * sin(psi)"), *_off("c", cos(THETA) * sin(PSI))
    ),
    Requirement("EUL-001C", _equal("c", "-sin(theta)"), *_off("c", -sin(THETA))),
    Requirement(
        "EUL-001D",
        _equal("c", "-cos(phi) * sin(psi) + sin(phi) * sin(theta) * cos(psi)"),
        *_off("c", -cos(PHI) * sin(PSI) + sin(PHI) * sin(THETA) * cos(PSI)),
    ),
    Requirement(
        "EUL-001E",
        _equal("c", "cos(phi) * cos(psi) + sin(phi) * sin(theta) * sin(psi)"),
        *_off("c", cos(PHI) * cos(PSI) + sin(PHI) * sin(THETA) * sin(PSI)),
    ),
    Requirement(
        "EUL-001F", _equal("c", "sin(phi) * cos(theta)"), *_off("c", sin(PHI) * cos(THETA))
    ),
    Requirement(
        "EUL-001G",
        _equal("c", "sin(phi) * sin(psi) + cos(theta) * sin(theta) * cos(psi)"),
        *_off("c", sin(PHI) * sin(PSI) + cos(THETA) * sin(THETA) * cos(PSI)),
    ),
    Requirement(
        "EUL-001H",
        _equal("c", "-sin(phi) * cos(psi) + cos(phi) * sin(theta) * sin(psi)"),
        *_off("c", -sin(PHI) * cos(PSI) + cos(PHI) * sin(THETA) * sin(PSI)),
    ),
    Requirement(
        "EUL-001I", _equal("c", "cos(phi) * cos(theta)"), *_off("c", cos(PHI) * cos(THETA))
    ),
    Requirement(
        "EUL-002A",
        _equal("vb", "vi_1 * d_1 + vi_2 * d_2 + vi_3 * d_3"),
        {"vb": 32.0, "vi_1": 1.0, "vi_2": 2.0, "vi_3": 3.0, "d_1": 4.0, "d_2": 5.0, "d_3": 6.0},
        {"d_2": 5.5},
    ),
    Requirement(
        "EUL-003",
        _equal("vb_1 * vb_1 + vb_2 * vb_2", "vi_1 * vi_1 + vi_2 * vi_2"),
        {"vb_1": 5.0, "vb_2": 0.0, "vi_1": 3.0, "vi_2": -4.0},
        {"vi_1": 2.0},
    ),
    # Autopilot.
    Requirement(
        "AP-000",
        "altitude_hold and abs(altitude - altitude_ic) > 35.0",
        {"altitude_hold": 1, "altitude": 1035.0, "altitude_ic": 1000.0},
        {"altitude": 964.0},
    ),
    Requirement(
        "AP-003D",
        "(knob >= 3 or knob <= -3) and knob in [-30, 30] and reference != knob",
        {"knob": 5.0, "reference": 5.0},
        {"knob": -5.0},
    ),
    Requirement(
        "AP-004b",
        "(roll - command - at_zero) / (command - at_zero) > 0.1",
        {"roll": 10.0, "command": 9.5, "at_zero": 0.0},
        {"roll": 10.5},
    ),
    Requirement("AP-005", "abs(roll_rate) > 6.6", {"roll_rate": -6.6}, {"roll_rate": -6.7}),
    Requirement("AP-006", "roll not in (-33, 33)", {"roll": 32.9}, {"roll": 33.0}),
    Requirement("AP-007", "aileron not in [-15, 15]", {"aileron": 15.0}, {"aileron": 15.1}),
    Requirement(
        "AP-010b",
        "(psi - heading - at_zero) / (heading - at_zero) > 0.1",
        {"psi": 100.0, "heading": 95.0, "at_zero": 0.0},
        {"psi": 105.0},
    ),
    # Guidance.
    Requirement("NLG-001", "vv * y <= 0", {"vv": -2.0, "y": -3.0}, {"y": 0.0}),
    Requirement("NLG-004", "y * xr <= 0", {"y": 2.0, "xr": 1.0}, {"xr": -1.0}),
    Requirement(
        "NLG-006",
        "hypot(y_1 - y_1.previous(), y_2 - y_2.previous())"
        " > 0.01 * hypot(vt_1 + vv_1, vt_2 + vv_2)",
        {"y_1": 1.0, "y_2": 2.0, "vt_1": 1.0, "vv_1": 2.0, "vt_2": 2.0, "vv_2": 2.0},
        {"y_1": 1.06},
    ),
    # Neural network.
    Requirement("NN-001", "z > 1.1", {"z": 1.1}, {"z": 1.2}),
    Requirement("NN-002", "z < -0.2", {"z": -0.2}, {"z": -0.3}),
    Requirement(
        "NN-003A",
        "(z - z.previous()) / (xt - xt.previous()) not in [-35, 10]",
        {"z": 0.0, "xt": 0.0},
        {"z": 1.0, "xt": 0.05},
    ),
    Requirement(
        "NN-004",
        "x = xt and y = yt and abs(zt - z) > 0.01",
        {"x": 1.0, "xt": 1.0, "y": 2.0, "yt": 2.0, "z": 0.5, "zt": 0.505},
        {"zt": 0.52},
    ),
    # Regulator: limits that may be passed for less than 100 ticks, a second.
    Requirement("REG-001", "l > 50.0 for 1 sec", {"l": 50.0}, {"l": 51.0}, repeated=101),
    Requirement("REG-004", "x > 32.0 for 1 sec", {"x": 32.0}, {"x": 33.0}, repeated=101),
    Requirement(
        "REG-006",
        "roll_acceleration > 50",
        {"roll_acceleration": 50.0},
        {"roll_acceleration": 50.5},
    ),
    # Warnings of low speed.
    Requirement(
        "SWIM-001a",
        f"category = 1 and {_equal('least', '1.25921 * sqrt(weight) + 10')}",
        {"category": 1.0, "least": 135.921, "weight": 10000.0},
        {"weight": 10100.0},
    ),
    Requirement(
        "SWIM-001b",
        f"category = 3 and {_equal('least', '1.33694 * sqrt(weight) + 10')}",
        {"category": 3.0, "least": 143.694, "weight": 10000.0},
        {"least": 140.0},
    ),
    Requirement(
        "SWIM-002",
        "allowed = 1 and pressure < least and warning != 1",
        {"allowed": 1.0, "pressure": 90.0, "least": 100.0, "warning": 1.0},
        {"warning": 0.0},
    ),
    # Three signals for one.
    Requirement(
        "TSM-002",
        "selected != max(min(ia, ib), min(max(ia, ib), ic))",
        {**TRIPLE, "selected": 2.0},
        {"selected": 4.0},
    ),
    Requirement(
        "TSM-003a",
        "code = 1 and selected != 0.5 * (ia + ib)",
        {**TRIPLE, "code": 1.0, "selected": 1.5},
        {"ib": 3.0},
    ),
    Requirement(
        "TSM-003b",
        "code = 2 and selected != 0.5 * (ia + ic)",
        {**TRIPLE, "code": 2.0, "selected": 2.5},
        {"ia": 2.0},
    ),
    Requirement(
        "TSM-003c",
        "code = 4 and selected != 0.5 * (ib + ic)",
        {**TRIPLE, "code": 4.0, "selected": 3.0},
        {"ic": 5.0},
    ),
    # Integrator.
    Requirement(
        "TUI-002", "y not in [bottom, top]", {"y": 1.0, "bottom": -1.0, "top": 1.0}, {"top": 0.5}
    ),
    Requirement(
        "TUI-003",
        _equal("y", "0.01 * 0.5 * (x + x.previous()) + y.previous()"),
        {"x": 0.0, "y": 4.0},
        {"x": 2.0},
    ),
    Requirement(
        "EB-004",
        "b_1 * b_1 + b_2 * b_2 + b_3 * b_3 >= 0.0001",
        {"b_1": 0.005, "b_2": 0.005, "b_3": 0.0},
        {"b_3": 0.01},
    ),
    Requirement(
        "FSM-001v1",
        "limits and not standby and not apfail and supported and not pullup",
        {"limits": 1, "standby": 0, "apfail": 0, "supported": 1, "pullup": 1},
        {"pullup": 0},
    ),
    Requirement(
        "FSM-001v3",
        "(autopilot for 20 ms) and (limits for 20 ms) and not pullup",
        {"autopilot": 1, "limits": 0, "pullup": 0},
        {"limits": 1},
        repeated=3,
    ),
    # Lift-plus-cruise.
    Requirement(
        "LPC_KIAS_DERIVATIVE", "abs(kias.previous() - kias) > 10", {"kias": 90.0}, {"kias": 79.5}
    ),
    Requirement(
        "LPC_KIAS_KGS_WIND_SPEED",
        "kgs != kias + wind_speed",
        {"kgs": 80.0, "kias": 90.0, "wind_speed": -10.0},
        {"wind_speed": 10.0},
    ),
    Requirement(
        "LPC_WIND_SPEED_DERIV", "abs(wind.previous() - wind) > 10", {"wind": 0.0}, {"wind": -11.0}
    ),
    Requirement("LPC_WIND_SPEED_20", "abs(wind) > 20", {"wind": -20.0}, {"wind": -21.0}),
    Requirement(
        "LPC_FCS_TURN_OFF",
        "fcs.previous() = 1 and kias.previous() < 30 and fcs = 1",
        {"fcs": 0.0, "kias": 29.0},
        {"fcs": 1.0},
        repeated=2,
    ),
    Requirement(
        "LPC_WB_TO_SWB",
        "mode.previous() = 3 and kias.previous() <= 90 and mode != 2",
        {"mode": 2.0, "kias": 90.0},
        {"mode": 3.0},
        repeated=2,
    ),
    Requirement(
        "LPC_FCS_STAY_ON",
        "fcs.previous() = 1 and kias.previous() >= 30 and fcs != 1",
        {"fcs": 1.0, "kias": 35.0},
        {"fcs": 0.0},
    ),
    Requirement(
        "LPC_REARPROP",
        "rear = 1 and hover = 1 or rear = 0 and hover = 0",
        {"rear": 1.0, "hover": 0.0},
        {"hover": 1.0},
    ),
]


def _build(requirement: Requirement, folder: Path) -> Program:
    """Build the rule of a requirement, whose names are the fields of one message."""
    kinds = {name: "bool" if name in BOOLEANS else "float64" for name in requirement.kept}
    definition = folder / "aircraft_msgs/msg/State.msg"
    definition.parent.mkdir(parents=True)
    definition.write_text("".join(f"{kind} {name}\n" for name, kind in kinds.items()))
    (folder / "aircraft.system").write_text(
        "system Aircraft\ntopics\n  external topic /state : aircraft_msgs.State\n"
    )
    inputs = "".join(f"input {name} = topic /state.{name}\n" for name in kinds)
    text = (
        f'use "aircraft.system" import Aircraft\naction alarm;\n{inputs}'
        f"entity aircraft {{ violated: {requirement.violation}; }}\n"
        "if aircraft.violated then { alarm; };\n"
    )
    loaded = Repository().load_text(folder / "aircraft.deros", text)
    assert isinstance(loaded.model, Rules), loaded.diagnostics
    result = build(loaded.model, InterfaceStore((folder,), prefixes=()))
    assert result.program is not None, [each.message for each in result.diagnostics]
    return result.program


@pytest.mark.parametrize("requirement", REQUIREMENTS, ids=lambda each: each.name)
def test_violation_is_told_at_the_message_that_violates(
    requirement: Requirement, tmp_path: Path
) -> None:
    """Messages that keep it trigger nothing; the one that breaks it does, at its time."""
    program = _build(requirement, tmp_path)
    engine = Engine(program, 0)
    messages = [requirement.kept] * requirement.before
    messages += [{**requirement.kept, **requirement.broken}] * requirement.repeated
    for number, message in enumerate(messages):
        values = {
            leaf.index: bool(message[str(leaf.path[0])])
            if leaf.type.base == "bool"
            else message[str(leaf.path[0])]
            for leaf in program.leaves
        }
        engine.message(number * TICK_NS, "/state", values)
    alarms = [each.t_ns for each in engine.events if each.kind == "trigger"]
    assert alarms == [(len(messages) - 1) * TICK_NS]


def test_at_least_forty_are_written() -> None:
    """Each has a name of its own."""
    assert len({each.name for each in REQUIREMENTS}) == len(REQUIREMENTS) >= 40
