"""Programs for tests, built against the robot of ``tests/cases/support/robot.system``."""

from __future__ import annotations

from functools import cache
from pathlib import Path

from deros.diagnostics import Diagnostic
from deros.interfaces.store import InterfaceStore
from deros.metamodels.load import Repository
from deros.models.rules import Rules
from deros.rules.compiler.build import BuildResult, build
from deros.rules.program import ir
from deros.validators.rules.rules import check_rules

_CASES = Path(__file__).resolve().parents[1] / "cases"


@cache
def embedded_store() -> InterfaceStore:
    """Return the definitions that come with the package, the same on every machine."""
    return InterfaceStore((), prefixes=())


def load(statements: str) -> Rules:
    """Return the typed model of ``statements``, which use the robot."""
    text = f'use "support/robot.system" import Robot\n{statements}'
    loaded = Repository().load_text(_CASES / "rules.deros", text)
    assert loaded.diagnostics == ()
    assert isinstance(loaded.model, Rules)
    return loaded.model


def build_rules(statements: str) -> BuildResult:
    """Build ``statements`` against the robot."""
    return build(load(statements), embedded_store())


def program(statements: str) -> ir.Program:
    """Build ``statements``, which must be free of errors."""
    result = build_rules(statements)
    assert result.program is not None, [each.message for each in result.diagnostics]
    return result.program


def condition(text: str, declarations: str = "") -> ir.Condition:
    """Return the condition of one rule."""
    return program(f"{declarations}\nentity e {{ r: {text}; }}").rules[0].condition


def findings(statements: str) -> list[tuple[str, str, str]]:
    """Check ``statements``; return code, place (the text there) and message of each finding."""
    model = load(statements)
    return [shown(each) for each in check_rules(model, build(model, embedded_store()))]


def shown(finding: Diagnostic) -> tuple[str, str, str]:
    """Return code, place and message of a finding."""
    return finding.code.name, finding.span.text, finding.message
