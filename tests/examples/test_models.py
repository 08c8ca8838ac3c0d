"""The models of the examples check clean in both languages."""

from __future__ import annotations

import shutil
from pathlib import Path

import pytest

from deros import codes
from deros.interfaces.store import InterfaceStore
from deros.metamodels.load import Repository
from deros.models.rules import Rules
from deros.validators.check import check
from tests.support.cli import deros
from tests.support.examples import EXAMPLES
from tests.support.real_systems import store

MODELS = sorted(p for s in (".rnd", ".system", ".deros") for p in EXAMPLES.rglob(f"*{s}"))


@pytest.mark.parametrize("model", MODELS, ids=lambda path: path.name)
def test_every_model_checks_without_findings(model: Path) -> None:
    """There are not even warnings; of a real system, remarks name what is not installed here."""
    repository = Repository()
    loaded = repository.load(str(model))
    is_real = EXAMPLES / "real" in model.parents
    found = check([loaded], repository, store() if is_real else InterfaceStore())
    unread = {codes.UNCHECKED_PARAMETER_FILE, codes.UNCHECKED_LAUNCH_FILE} if is_real else set()
    assert [each for each in found if each.code not in unread] == []


@pytest.mark.parametrize("example", ["feeding_robot", "frobit", "intelligent_one", "kobuki"])
def test_two_words_in_the_system_select_the_language(example: str, tmp_path: Path) -> None:
    """Safety node and gate in C++ replace those in Python."""
    folder = tmp_path / example
    shutil.copytree(EXAMPLES / example, folder)
    system = folder / f"{example}.system"
    rules = f'safety "{example}.deros"'
    text = system.read_text(encoding="utf-8")
    assert text.count(rules) == 1
    system.write_text(text.replace(rules, f"{rules} target cpp"), encoding="utf-8")
    outcome = deros("check", system, folder / f"{example}.deros", "--strict")
    assert (outcome.code, outcome.err) == (0, "")


@pytest.mark.parametrize("example", ["frobit", "intelligent_one", "kobuki"])
def test_examples_have_tests_that_reach_all_of_them(example: str) -> None:
    """Their timelines pass, and there is nothing in their rules that these do not try."""
    outcome = deros("test", "--strict", EXAMPLES / example)
    assert (outcome.code, outcome.err) == (0, ""), outcome.out


def test_feeding_robot_rules_cite_every_requirement() -> None:
    """Each of the seven requirements of the risk list is next to a rule that meets it."""
    text = (EXAMPLES / "feeding_robot/feeding_robot.deros").read_text()
    entities = text[text.index("entity ") : text.index("behaviour ")]
    assert all(f"[R{number}]" in entities for number in range(1, 8))


def test_feeding_robot_has_the_entities_and_actions_of_its_risk_assessment() -> None:
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
