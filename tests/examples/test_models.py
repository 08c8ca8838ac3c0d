"""The examples' models check clean, and the safety node's description in them is up to date."""

from __future__ import annotations

import re
import shutil
from pathlib import Path

import pytest

from deros.generators.protocol import Context
from deros.generators.registry import discover
from deros.generators.writer import write
from deros.interfaces.store import InterfaceStore
from deros.metamodels.load import Repository
from deros.metamodels.rules import Rules
from deros.validators.check import check
from tests.support.cli import deros
from tests.support.examples import EXAMPLES

MODELS = sorted(p for s in (".rnd", ".system", ".deros") for p in EXAMPLES.rglob(f"*{s}"))


@pytest.mark.parametrize("model", MODELS, ids=lambda path: path.name)
def test_every_model_checks_without_a_finding(model: Path) -> None:
    """Not even a warning: what we show is what we ask for."""
    repository = Repository()
    loaded = repository.load(str(model))
    assert check([loaded], repository, InterfaceStore()) == []


@pytest.mark.parametrize("target", ["python", "cpp"])
@pytest.mark.parametrize(
    ("rules", "folder"),
    [
        ("feeding_robot/feeding_robot.deros", "nodes"),
        ("intelligent_one/intelligent_one.deros", "."),
    ],
)
def test_the_generated_nodes_are_described_as_their_rules_have_them(
    rules: str, folder: str, target: str, tmp_path: Path
) -> None:
    """If this fails: generate the rules' package and copy its .rnd files over those there."""
    path = EXAMPLES / rules
    repository = Repository()
    generator = discover().find("deros", target)
    assert generator is not None
    loaded = repository.load(str(path))
    write(generator(loaded.model, Context(InterfaceStore(), repository)), tmp_path)
    generated = list(tmp_path.rglob("*.rnd"))
    assert len(generated) == 2  # the safety node and its gate
    for each in generated:
        assert (path.parent / folder / each.name).read_text() == each.read_text()


@pytest.mark.parametrize(
    ("example", "nodes"),
    [
        ("feeding_robot", ("feeding_robot_safety_node", "actuators_command_gate")),
        ("intelligent_one", ("intelligent_one_safety_node", "command_gate")),
    ],
)
def test_one_word_in_the_system_chooses_the_language(
    example: str, nodes: tuple[str, ...], tmp_path: Path
) -> None:
    """The safety node and the gate in C++ stand where those in Python stood, each or both."""
    folder = tmp_path / example
    shutil.copytree(EXAMPLES / example, folder)
    system = folder / f"{example}.system"
    for node in nodes:
        text, count = re.subn(rf": {node}\b", f": {node}_cpp", system.read_text(encoding="utf-8"))
        assert count == 1
        system.write_text(text, encoding="utf-8")
        outcome = deros("check", system, folder / f"{example}.deros", "--strict")
        assert (outcome.code, outcome.err) == (0, "")


def test_the_rules_of_the_feeding_robot_cite_every_requirement() -> None:
    """Each of the seven requirements of the risk list stands beside a rule that meets it."""
    text = (EXAMPLES / "feeding_robot/feeding_robot.deros").read_text()
    entities = text[text.index("entity ") : text.index("behaviour ")]
    assert all(f"[R{number}]" in entities for number in range(1, 8))


def test_the_feeding_robot_has_the_entities_and_actions_of_its_risk_assessment() -> None:
    """Four entities, four actions, and at least fourteen rules and behaviours."""
    rules = Repository().load(str(EXAMPLES / "feeding_robot/feeding_robot.deros")).model
    assert isinstance(rules, Rules)
    assert {str(e.name) for e in rules.entities} == {
        "imu_sensor_system",
        "collision_detection",
        "PLC_system",
        "drive_system",
    }
    assert {str(a.name) for a in rules.actions} == {
        "low_speed",
        "stop",
        "motor_stop",
        "controllerOk",
    }
    assert sum(len(entity.rules) for entity in rules.entities) >= 14
    assert len(rules.behaviours) >= 14
