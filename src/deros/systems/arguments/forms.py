"""The forms in which a part of a system may be there, each with its assignments."""

from __future__ import annotations

import contextlib
import itertools
from collections.abc import Sequence

from deros.diagnostics import Span
from deros.models.arguments import Expression
from deros.models.common import Scalar
from deros.models.parameter_files import ParameterFile
from deros.systems.arguments.assignments import MOST_CLASSES, Space
from deros.systems.arguments.diagrams import Assignments, TooManyCombinations
from deros.systems.arguments.evaluate import CannotEvaluate, evaluate
from deros.systems.arguments.scopes import Scope
from deros.systems.arguments.varied import Part


def forms_of(part: Part, space: Space) -> list[Assignments]:
    """Return the assignments of each form in which a part may be there, ordered by their values.

    They are disjoint. Forms differ in which of the part's inner conditions hold, and in what has
    been computed: of the values for a parameter file, in those that the file uses. Where something
    cannot be evaluated is one form: it is reported where it is written.

    Raises:
        TooManyCombinations: the part has too many forms.
    """
    forms = _forms(part, space, [_by_value(space, *each) for each in part.computed])
    for scope, file in part.files:
        cut = (_by_used(space, scope, file, form, part.place[1]) for form in forms)
        forms = sorted(itertools.chain(*cut), key=lambda each: each.first)
    return forms


def ways_of(part: Part, space: Space) -> list[Assignments]:
    """Return the forms of a part by its conditions alone, ordered by their values.

    Raises:
        TooManyCombinations: there are too many.
    """
    return _forms(part, space, [])


_Cut = tuple[Sequence[Assignments], Assignments]
"""What cuts a part into forms, and the assignments for which it cannot be evaluated."""


def _forms(part: Part, space: Space, computed: Sequence[_Cut]) -> list[Assignments]:
    alive, failing = space.everything, space.nothing
    for scope, condition in part.present:
        holding, fails = space.decided(condition, scope)
        failing |= alive & fails
        alive &= holding
    cuts = list(computed)
    for scope, condition in part.inner:
        holding, fails = space.decided(condition, scope)
        cuts.append(((holding, space.everything - holding), fails))
    for _, fails in cuts:
        failing |= alive & fails
        alive -= fails
    forms = [alive] if alive else []
    for cut, _ in cuts:
        forms = _cut(forms, cut, part.place[1])
    if failing:
        forms.append(failing)
    return sorted(forms, key=lambda each: each.first)


def _cut(
    forms: Sequence[Assignments], cut: Sequence[Assignments], place: Span
) -> list[Assignments]:
    """Return forms of what stands at a place, cut into more."""
    found = [both for form in forms for each in cut if (both := form & each)]
    if len(found) > MOST_CLASSES:
        raise TooManyCombinations(place)
    return found


def _by_used(
    space: Space, scope: Scope, file: ParameterFile, form: Assignments, place: Span
) -> Sequence[Assignments]:
    """Return a form of a part, cut by the values for a file: those that the file uses."""
    path: Scalar = file.path
    if file.path_from is not None:
        values = space.assignment(space.smallest(form))
        try:
            path = evaluate(file.path_from, scope.values(values))
        except CannotEvaluate:
            return [form]
    used = file.used_at(path) if isinstance(path, str) else frozenset()
    forms = [form]
    for each in file.given or ():
        if each.name in used and each.value_from is not None:
            by_value, failing = _by_value(space, scope, each.value_from)
            forms = _cut(forms, (*by_value, failing), place)
    return forms


def _by_value(space: Space, scope: Scope, found: Expression) -> _Cut:
    by_value: dict[Scalar, Assignments] = {}
    known = space.nothing
    for values, mask in space.classes_of(found, scope):
        with contextlib.suppress(CannotEvaluate):
            value = evaluate(found, scope.values(values))
            by_value[value] = by_value.get(value, space.nothing) | mask
            known |= mask
    return tuple(by_value.values()), space.everything - known
