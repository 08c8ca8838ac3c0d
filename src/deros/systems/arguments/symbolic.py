"""A system whose values are left to be computed when it is started, for generators.

Each node comes once for every way in which its conditions can turn out, with the condition of that
way. What is computed from arguments stands in its texts as a *mark*, so that names resolve as those
of any other system; :meth:`SymbolicSystem.pieces` gives the expressions back.
"""

from __future__ import annotations

import re
from collections import defaultdict
from collections.abc import Iterator
from dataclasses import dataclass, replace

from deros.models.arguments import (
    Argument,
    Calculation,
    Chosen,
    Compared,
    Condition,
    Expression,
    Holds,
    Interpolation,
    Joined,
    Literally,
    Lookup,
    Not,
    OneOf,
    Opposite,
    lookups_in,
    made_in,
    merged,
    open_in,
)
from deros.models.common import Scalar
from deros.models.launch_files import XacroFile
from deros.models.node import ParameterType
from deros.models.system import System
from deros.systems.arguments.assignments import Space
from deros.systems.arguments.diagrams import Assignments
from deros.systems.arguments.evaluate import CannotEvaluate, evaluate, expression_type, holds
from deros.systems.arguments.forms import ways_of
from deros.systems.arguments.resolve import Named, Resolution
from deros.systems.arguments.scopes import Scope
from deros.systems.arguments.varied import Part, place_of, varied
from deros.systems.flat import FlatLaunch, FlatNode, FlatProcess, FlatTopic
from deros.systems.flatten import flatten

_MARK = re.compile("\ue000(\\d+)\ue001")
"""Characters for private use, which no name has: their numbers are those of expressions."""


def is_computed(text: str) -> bool:
    """Return whether a text has marks in it."""
    return _MARK.search(text) is not None


_OPEN = "\ue002"
"""Stands before a text that begins with a mark: whether it is an absolute name is open."""


def as_written(name: str) -> str:
    """Return a resolved name that began with what is computed as it was before.

    Only its value shows whether it is absolute; ROS 2 then resolves it as this model has done.
    """
    return name.rpartition(_OPEN)[2]


def joined(name: str) -> str:
    """Return a resolved name with all that it has been resolved with.

    Where its value shows that a part was absolute, two ``/`` stand before that part.
    """
    return name.replace(_OPEN, "")


_FlatPart = FlatNode | FlatProcess | FlatLaunch | FlatTopic


@dataclass(frozen=True, slots=True)
class SymbolicNode:
    """A program at run time, where ``when`` holds; always, if that is ``None``."""

    node: FlatNode | FlatProcess | FlatLaunch
    when: Condition | None


@dataclass(frozen=True, slots=True)
class SymbolicTopic:
    """A declared topic, where ``when`` holds; always, if that is ``None``."""

    topic: FlatTopic
    when: Condition | None


class SymbolicSystem:
    """The parts of a system at run time in terms of its arguments, in the order written.

    Declared topics stand apart.
    """

    def __init__(self, system: System, root: str = "/") -> None:
        """Expand ``system``, which is without faults, as started in the namespace ``root``.

        Raises:
            TooManyCombinations: of the arguments that its conditions depend on.
        """
        self._system = system
        self._root = root
        self._expressions: list[Expression] = []
        found = varied(system)
        self._space: Space = found.space
        self._flat: dict[int, dict[object, list[_FlatPart]]] = {}
        parts = [each for part in found.parts for each in self._of_part(part)]
        self.nodes: tuple[SymbolicNode, ...] = tuple(
            each for each in parts if isinstance(each, SymbolicNode)
        )
        self.topics: tuple[SymbolicTopic, ...] = tuple(
            each for each in parts if isinstance(each, SymbolicTopic)
        )

    def pieces(self, text: str) -> tuple[str | Expression, ...]:
        """Return the pieces of a text that may have marks in it; of an empty one, none."""
        found: list[str | Expression] = []
        for position, piece in enumerate(_MARK.split(text)):
            if position % 2:
                found.append(self._expressions[int(piece)])
            elif piece:
                found.append(piece)
        return tuple(found)

    def type_of(self, pieces: tuple[str | Expression, ...]) -> ParameterType:
        """Return the type of what the pieces of a text make: of one expression, its own."""
        if len(pieces) != 1 or isinstance(pieces[0], str):
            return ParameterType.STRING
        types = {each.name: each.type for each in self._system.arguments}
        return expression_type(pieces[0], types)

    @property
    def looks_up(self) -> bool:
        """Whether something is looked up where the system is started."""
        return any(lookup for each in self._expressions for lookup in lookups_in(each))

    @property
    def made(self) -> tuple[Lookup, ...]:
        """The files that are made, each by a use of its path, in terms of the arguments."""
        return tuple(dict.fromkeys(use for each in self._expressions for use in made_in(each)))

    def mark(self, expression: Expression) -> str:
        """Return the mark that stands for an expression in texts."""
        if expression not in self._expressions:
            self._expressions.append(expression)
        return f"\ue000{self._expressions.index(expression)}\ue001"

    def _of_part(self, part: Part) -> Iterator[SymbolicNode | SymbolicTopic]:
        for mask in ways_of(part, self._space):
            number = self._space.smallest(mask)
            when = self._when(part, number, mask)
            for flat in self._flat_parts(number).get(part.place, ()):
                if isinstance(flat, FlatTopic):
                    yield SymbolicTopic(flat, when)
                else:
                    yield SymbolicNode(flat, when)

    def _flat_parts(self, number: int) -> dict[object, list[_FlatPart]]:
        """Return what is there for an assignment that decides conditions, by its places."""
        if number not in self._flat:
            work = _Marking(self, self._space.assignment(number))
            resolved = work.system(self._system, Scope(self._system.arguments), (self._system,))
            found: dict[object, list[_FlatPart]] = defaultdict(list)
            flat = flatten(resolved, self._root)
            for node in flat.parts:
                found[place_of(node)].append(node)
            for topic in flat.topics:
                found[topic.path, topic.declaration.name_span].append(topic)
            self._flat[number] = found
        return self._flat[number]

    def _when(self, part: Part, number: int, mask: Assignments) -> Condition | None:
        """Return the fewest conditions that together hold in the assignments of ``mask`` alone."""
        outermost = Scope(self._system.arguments)
        values = outermost.values(self._space.assignment(number))
        needed: list[Condition] = []
        for scope, condition in (*part.present, *part.inner):
            found = inlined_condition(condition, scope)
            if isinstance(found, bool):
                continue
            truth = holds(found, values)
            for each in conjuncts(found) if truth else (negated(found),):
                if each not in needed:
                    needed.append(each)
        masks = {each: self._space.where(each, outermost) for each in needed}
        for each in reversed(needed.copy()):
            others = self._space.everything
            for other in needed:
                if other is not each:
                    others &= masks[other]
            if others == mask:
                needed.remove(each)
        if not needed:
            return None
        return needed[0] if len(needed) == 1 else Joined("and", tuple(needed), needed[0].span)


class _Marking(Resolution):
    """Puts marks in place of what is computed; conditions are decided."""

    def __init__(self, system: SymbolicSystem, values: dict[str, Scalar]) -> None:
        super().__init__(values)
        self._system = system

    def value(self, expression: Expression, scope: Scope) -> Scalar | None:
        found = inlined(expression, scope)
        if isinstance(found, Literally):
            return found.value
        pieces: tuple[str | Expression, ...] = (found,)
        if isinstance(found, Interpolation) and len(found.pieces) > 1:
            # One of a number alone stays a text: the mark of the number would stand for a number.
            pieces = found.pieces
        texts = (each if isinstance(each, str) else self._system.mark(each) for each in pieces)
        return ("" if isinstance(pieces[0], str) else _OPEN) + "".join(texts)

    def is_assumed(self, expression: Expression, scope: Scope) -> bool:
        return not isinstance(inlined(expression, scope), Literally)

    def _placed(self, part: Named, scope: Scope) -> Named:
        placed = super()._placed(part, scope)
        if placed.namespace is None:
            return placed
        return replace(placed, namespace=placed.namespace.replace(_OPEN, ""))


def conjuncts(condition: Condition) -> tuple[Condition, ...]:
    """Return the conditions that all hold where a condition does."""
    if isinstance(condition, Joined) and condition.word == "and":
        return condition.operands
    return (condition,)


def negated(condition: Condition) -> Condition:
    """Return the opposite of a condition."""
    return condition.operand if isinstance(condition, Not) else Not(condition, condition.span)


# In terms of the outermost arguments --------------------------------------------------------------


def inlined(found: Expression, scope: Scope) -> Expression:
    """Return an expression in terms of the outermost arguments; what is constant is calculated.

    Raises:
        CannotEvaluate: what is constant has no value, or uses an unknown argument.
    """
    match found:
        case Argument(name) if scope.outer is not None:
            meaning = scope.meaning(name)
            if meaning is None:
                return Literally(evaluate(found, scope.values({})), found.span)
            return _typed(inlined(*meaning), found, scope)
        case Interpolation(pieces):
            joined = merged(p if isinstance(p, str) else inlined(p, scope) for p in pieces)
            if all(isinstance(piece, str) for piece in joined):
                return Literally("".join(map(str, joined)), found.span)
            (first, *others) = joined
            if others or isinstance(first, str):
                return Interpolation(joined, found.span)
            is_text = _type_of(first, scope) is ParameterType.STRING
            return first if is_text else Interpolation(joined, found.span)
        case Calculation(left=left, right=right):
            found = replace(found, left=inlined(left, scope), right=inlined(right, scope))
        case Opposite(operand):
            found = replace(found, operand=inlined(operand, scope))
        case Lookup(made=XacroFile() as made):
            return replace(found, made=_inlined_file(made, scope))
        case Lookup(name_from=name) if name is not None:
            return _inlined_share(found, inlined(name, scope))
        case Chosen(condition, chosen, otherwise):
            known = inlined_condition(condition, scope)
            if isinstance(known, bool):
                return _typed(inlined(chosen if known else otherwise, scope), found, scope)
            both = [_typed(inlined(each, scope), found, scope) for each in (chosen, otherwise)]
            return both[0] if both[0] == both[1] else Chosen(known, both[0], both[1], found.span)
    if any(open_in(found)):
        return found
    return Literally(evaluate(found, {}), found.span)


def _type_of(found: Expression, scope: Scope) -> ParameterType:
    """Return the type of an expression in terms of the outermost arguments."""
    while scope.outer is not None:
        scope = scope.outer
    return expression_type(found, {each.name: each.type for each in scope.arguments})


def _typed(found: Expression, written: Expression, scope: Scope) -> Expression:
    """Return a value, in terms of the outermost arguments, with the type that is ``written``.

    An integer is given where a double is declared, and stands beside one in a choice.
    """
    types = {each.name: each.type for each in scope.arguments}
    kinds = _type_of(found, scope), expression_type(written, types)
    if kinds != (ParameterType.INTEGER, ParameterType.DOUBLE):
        return found
    if isinstance(found, Literally):
        return replace(found, value=float(found.value))
    return Calculation("*", Literally(1.0, found.span), found, found.span)


def _inlined_share(found: Lookup, name: Expression) -> Lookup:
    if isinstance(name, Literally):
        return replace(found, name=str(name.value), name_from=None)
    return replace(found, name_from=name)


def _inlined_file(found: XacroFile, scope: Scope) -> XacroFile:
    """Return a file with its path and its arguments in terms of the outermost arguments."""
    return replace(
        found,
        path_from=None if found.path_from is None else inlined(found.path_from, scope),
        arguments=tuple(
            each
            if each.value_from is None
            else replace(each, value_from=inlined(each.value_from, scope))
            for each in found.arguments
        ),
    )


def inlined_condition(found: Condition, scope: Scope) -> Condition | bool:
    """Return a condition in terms of the outermost arguments, or what it is for all of them."""
    match found:
        case Holds(operand) | OneOf(operand=operand):
            found = replace(found, operand=inlined(operand, scope))
        case Compared(left=left, right=right):
            found = replace(found, left=inlined(left, scope), right=inlined(right, scope))
        case Not(operand):
            inner = inlined_condition(operand, scope)
            return not inner if isinstance(inner, bool) else negated(inner)
        case Joined(word, operands):
            decisive = word == "or"
            inside = [inlined_condition(each, scope) for each in operands]
            if decisive in inside:
                return decisive
            left_over = tuple(each for each in inside if not isinstance(each, bool))
            if len(left_over) < 2:
                return left_over[0] if left_over else not decisive
            return replace(found, operands=left_over)
    try:
        return found if any(open_in(found)) else holds(found, {})
    except CannotEvaluate:  # which is reported where it is written
        return False
