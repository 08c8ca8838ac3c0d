"""Each command loads, checks and builds its models once."""

from __future__ import annotations

from pathlib import Path

import pytest

from deros.interfaces.store import InterfaceStore
from deros.models.rules import Rules
from deros.pipeline.workspace import load
from deros.rules.compiler import build as builder
from deros.rules.compiler.build import BuildResult
from tests.support.cli import deros


@pytest.fixture
def built(monkeypatch: pytest.MonkeyPatch) -> list[str]:
    """Return the names of the rules built so far, one entry per build."""
    names: list[str] = []
    genuine = builder.build

    def counting(rules: Rules, store: InterfaceStore) -> BuildResult:
        names.append(rules.name)
        return genuine(rules, store)

    monkeypatch.setattr(builder, "build", counting)
    return names


@pytest.fixture
def models(tmp_path: Path) -> Path:
    """Create a folder with rules, their system and its node."""
    assert deros("new", "rules", "courier", "-o", tmp_path / "models").code == 0
    return tmp_path / "models"


@pytest.mark.parametrize("target", ["python", "cpp", "c"])
def test_generate_builds_rules_once(
    built: list[str], models: Path, tmp_path: Path, target: str
) -> None:
    """The generator gets the result of the checks."""
    outcome = deros(
        "generate", models / "courier.deros", "--target", target, "-o", tmp_path / "out"
    )
    assert outcome.code == 0, outcome.err
    assert built == ["courier"]


def test_check_builds_rules_once(built: list[str], models: Path) -> None:
    """This includes rules that are given and also named by a system in the folder."""
    assert deros("check", models).code == 0
    assert built == ["courier"]


@pytest.mark.parametrize("monitor", ["reference", "python"])
def test_simulate_builds_rules_once(
    built: list[str], models: Path, tmp_path: Path, monitor: str
) -> None:
    """The program of the simulation is the only one built."""
    trace = tmp_path / "trace.jsonl"
    trace.write_text('{"t": "1", "topic": "/resume", "data": {"data": true}}\n')
    outcome = deros("simulate", models / "courier.deros", "--trace", trace, "--monitor", monitor)
    assert outcome.code == 0, outcome.err
    assert built == ["courier"]


def test_workspace_shares_its_builds_with_generators(models: Path) -> None:
    """The context of generators returns the result of the checks."""
    workspace = load([str(models / "courier.deros")])
    assert workspace.check().findings == []
    model = workspace.files[0].model
    assert isinstance(model, Rules)
    assert workspace.context().build(model) is workspace.builds.of(model)
