"""Requirements that others have published can be written as rules, and are violated when they are.

They are listed, with their sources, in ``tests/data/public_requirements.md``.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path

import pytest

from deros.interfaces.store import InterfaceStore
from deros.metamodels.load import Repository
from deros.models.rules import Rules
from deros.rules.compiler.build import build
from deros.rules.engine.engine import Engine
from deros.rules.program.ir import Program
from tests.support.tables import rows

TICK_NS = 10_000_000
BOOLEANS = ("altitude_hold", "autopilot", "limits", "standby", "apfail", "supported", "pullup")


@dataclass(frozen=True)
class Requirement:
    """A requirement.

    Attributes:
        name: in its source.
        violation: when it is violated, as a rule; its names are fields of one message.
        kept: the values of a message that keeps it.
        broken: what is different in a message that violates it.
        times: how often the message comes that violates it; the last one does.
    """

    name: str
    violation: str
    kept: Mapping[str, float]
    broken: Mapping[str, float]
    times: int


def _values(cell: str) -> dict[str, float]:
    pairs = (each.split(" = ") for each in cell.split(", "))
    return {name: float(value) for name, value in pairs}


REQUIREMENTS = [
    Requirement(
        each["name"],
        each["violated"],
        _values(each["kept"]),
        _values(each["broken"]),
        int(each["times"] or 1),
    )
    for each in rows("public_requirements")
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
    messages = [requirement.kept] * 2
    messages += [{**requirement.kept, **requirement.broken}] * requirement.times
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
