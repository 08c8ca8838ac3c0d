"""Planted slips: patterns describe places in code, and changes are made there alone."""

from __future__ import annotations

import pytest

from tests.support import c_planted, python_mutants
from tests.support.c_mutants import TABLES
from tests.support.slips import Slip, matches

C = """\
static const site sites[1] = {{ACTION_A, 61U, 1U}};
static bool f(monitor *m, int a)
{
  m->x_known = true;  /* a < 3 */
  if ((a < 3) && !m->y_known) {
    m->x_known = false;
  }
  return g(m->y_known, a < 4);
}
static bool other(int a)
{
  return a < 3;
}
"""

PYTHON = '''\
class Monitor:
    def act(self, t):
        """a or b"""
        if self._x or (self._y  # either
                or t > 3):
            x_due = self._x_due = NEVER
            self._act(t)
        self._y = False

    def other(self, t):
        return 'é' > t

    def held(self, t):
        return [each for each in self._all if each < t]
'''


@pytest.mark.parametrize(
    ("pattern", "code", "is_met"),
    [
        ("m->$_known", "m -> x_known /* or not */", True),
        ("m->$_known", "m->x_known_2", False),
        ("m->$_known$", "m->x_known_2", True),
        ("$1 == $1", "x == x", True),
        ("$1 == $1", "x == y", False),
        ("f($$, b)", "f(a(1, 2), b)", True),
        ("f($$)", "f()", True),
        ("$", "a + b", False),
        ("values[i] < x", "values[i] < x", True),
        ("a < b", "a <= b", False),
    ],
)
def test_pattern_is_compared_by_tokens(pattern: str, code: str, is_met: bool) -> None:
    """Spaces and comments do not count; a wildcard stays within its token."""
    assert matches(pattern, code) == is_met


@pytest.mark.parametrize(
    ("slip", "before", "after"),
    [
        (Slip("comparison", "f", "a < $", "<="), ("(a < 3)", "a < 4)"), ("(a <= 3)", "a <= 4)")),
        (Slip("statement", "f", "m->$ = true;"), ("m->x_known = true;",), (";",)),
        (Slip("constant", "f", "true", "", "m->x_known = @"), ("= true",), ("= false",)),
        (Slip("constant", TABLES, "$U", "", "{ACTION_$, @ $$}"), ("61U",), ("62U",)),
        (Slip("value", "f", "m->$_known", "0", "g(@, $$)"), ("g(m->y_known",), ("g(0",)),
        (Slip("bound", "f", "a", "", "@ < 4"), ("a < 4",), ("(a + 1) < 4",)),
        (Slip("operator", "$", "$$ && $$"), ("&&",), ("||",)),
    ],
)
def test_slip_in_c_is_made_at_its_places(
    slip: Slip, before: tuple[str, ...], after: tuple[str, ...]
) -> None:
    """All else stays as it is, other functions and comments included."""
    wanted = C
    for old, new in zip(before, after, strict=True):
        assert wanted.count(old) == 1
        wanted = wanted.replace(old, new)
    assert c_planted.planted(C, "", [slip]) == wanted


@pytest.mark.parametrize(
    ("slip", "before", "after"),
    [
        (Slip("operator", "act", "$$ or $$"), ("_x or", " or t"), ("_x and", " and t")),
        (Slip("comparison", "other", "$$ > t", ">="), ("'é' > t",), ("'é' >= t",)),
        (Slip("comparison", "held", "$ < t"), (" < t",), (" <= t",)),
        (Slip("statement", "act", "self._act(t)"), ("self._act(t)",), ("pass",)),
        (Slip("target", "act", "self._x_due"), ("self._x_due = NEVER",), ("NEVER",)),
        (Slip("value", "act", "t > 3", "False"), ("t > 3",), ("False",)),
        (Slip("constant", "act", "False"), ("= False",), ("= True",)),
        (
            Slip("once", "act", "self._y = $"),
            ("self._y = False",),
            ("self._y = getattr(self, '_y', False)",),
        ),
    ],
)
def test_slip_in_python_is_made_at_its_places(
    slip: Slip, before: tuple[str, ...], after: tuple[str, ...]
) -> None:
    """All else stays as it is, other functions, comments and documentation included."""
    wanted = PYTHON
    for old, new in zip(before, after, strict=True):
        assert wanted.count(old) == 1
        wanted = wanted.replace(old, new)
    assert python_mutants.planted(PYTHON, [slip]) == wanted


def test_slip_without_a_place_is_not_made() -> None:
    """Nor are those that belong to it."""
    found = Slip("value", "$", "m->y_known", "true")
    assert c_planted.planted(C, "", [found]) is not None
    assert c_planted.planted(C, "", [found, Slip("statement", "f", "m->z = true;")]) is None
    found = Slip("statement", "act", "self._act(t)")
    assert python_mutants.planted(PYTHON, [found]) is not None
    assert python_mutants.planted(PYTHON, [found, Slip("once", "act", "self._z = $")]) is None
