"""Broken programs never raise an exception in the checks."""

from __future__ import annotations

import re
from pathlib import Path

import pytest
from hypothesis import HealthCheck, example, given, settings
from hypothesis import strategies as st

from deros.metamodels.load import Repository
from deros.models.rules import Rules
from deros.rules.compiler.build import build
from deros.validators.rules.rules import check_rules
from tests.support.profiles import scaled
from tests.support.rules import embedded_store

_CASES = Path(__file__).resolve().parents[2] / "cases"
_PATHS = sorted(_CASES.glob("DRS3*.deros"))
_TEXTS = [re.sub(r"//.*", "", path.read_text()) for path in _PATHS]
_TOKENS = [re.findall(r'"[^"]*"|->|[~/]?[\w/.]+|[^\w\s]', text) for text in _TEXTS]
_WORDS = sorted({token for tokens in _TOKENS for token in tokens})


@st.composite
def programs(draw: st.DrawFn) -> str:
    """Draw a bad program with words added, replaced or left out."""
    tokens = list(draw(st.sampled_from(_TOKENS)))
    for _ in range(draw(st.integers(0, 3))):
        place = draw(st.integers(10, len(tokens) - 1))
        tokens[place : place + draw(st.integers(0, 1))] = draw(
            st.lists(st.sampled_from(_WORDS), max_size=1)
        )
    return " ".join(tokens)


_CYCLE_WITHOUT_SYSTEM = """
use "support/missing.system" import Robot
action stop;
input v = topic /speed.data timeout 1 sec
entity drive { fast: v > 1; late: stop.active for 1 sec; }
if drive.late then { stop; };
"""


@settings(max_examples=scaled(150), suppress_health_check=[HealthCheck.too_slow])
@example(_CYCLE_WITHOUT_SYSTEM)
@given(text=programs())
def test_any_parsed_program_is_checked_without_exception(text: str) -> None:
    """Each finding has a message and a valid span."""
    _check(text)


@pytest.mark.parametrize("text", _TEXTS, ids=[path.stem for path in _PATHS])
def test_program_is_checked_without_its_systems(text: str) -> None:
    """What depends on a system that could not be loaded is left out, and nothing relies on it."""
    _check(re.sub(r"support/\w+\.system", "support/missing.system", text))


def _check(text: str) -> None:
    loaded = Repository().load_text(_CASES / "rules.deros", text)
    if not isinstance(loaded.model, Rules):
        return
    for finding in check_rules(loaded.model, build(loaded.model, embedded_store())):
        assert finding.message
        assert finding.span.end <= len(finding.span.source.text)
