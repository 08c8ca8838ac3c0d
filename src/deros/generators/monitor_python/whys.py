"""The methods that tell why a rule is true, or false, and why a behaviour holds."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, replace
from typing import TypeVar

from deros.generators.monitor_python.conditions import Conditions
from deros.generators.monitor_python.explained import value_text
from deros.generators.monitor_python.layout import Layout
from deros.generators.monitor_python.logic import MAX_LINE, lay_out, lay_out_call
from deros.monitor import walk
from deros.monitor.causes import Plan, Say, SayRule, SayUnknown, When, plan_of, plan_of_behaviour
from deros.monitor.ir import Age, For, Program
from deros.monitor.reads import term_name

_PLACE = "\0"  # stands for a value while a text is quoted

Key = TypeVar("Key")


@dataclass(frozen=True, slots=True)
class Why:
    """A method that tells why something is as it is.

    Attributes:
        method: its name, without the leading ``_``.
        subject: what it tells the causes of.
        lines: of its body.
    """

    method: str
    subject: str
    lines: tuple[str, ...]


def whys(program: Program, layout: Layout) -> Iterator[Why]:
    """Yield the methods of all rules, then of all behaviours."""
    emitter = _Emitter(program, layout)
    for rule in program.rules:
        for methods, holds in ((layout.why, True), (layout.why_not, False)):
            if rule.index in methods:
                lines = emitter.body(plan_of(program, rule.condition, holds))
                subject = f"{rule.full_name} is {str(holds).lower()}"
                yield Why(methods[rule.index], subject, tuple(lines))
    for behaviour in walk.behaviours(program):
        lines = emitter.body(plan_of_behaviour(program, behaviour))
        yield Why(layout.why_holds[behaviour.index], f"{behaviour.name} holds", tuple(lines))


class _Emitter:
    """Emits plans. Conditions read the attributes themselves, as causes are told seldom."""

    def __init__(self, program: Program, layout: Layout) -> None:
        self._program = program
        self._layout = layout
        own = replace(
            layout,
            values={
                value: replace(slot, name=f"self._{slot.name}")
                for value, slot in layout.values.items()
            },
            silent=_of_self(layout.silent),
            missing=_of_self(layout.missing),
            known=_of_self(layout.known),
            counted=_of_self(layout.counted),
            dues=_of_self(layout.dues),
            verdicts=_of_self(layout.verdicts),
        )
        self._conditions = Conditions(program, own)

    def body(self, plan: Plan) -> list[str]:
        if not any(isinstance(part, When) for part in plan):
            return _tuple_of([self._cause(part) for part in plan])
        lines = ["        t = self._now"] if _asks_for_time(plan) else []
        return [*lines, "        found = []", *self._block(8, plan), "        return tuple(found)"]

    def _block(self, indent: int, plan: Plan) -> list[str]:
        blank = " " * indent
        lines: list[str] = []
        for part in plan:
            if not isinstance(part, When):
                lines += lay_out_call(indent, "found.append(", [self._cause(part)])
                continue
            asked = self._conditions.true if part.holds else self._conditions.false
            lines += lay_out(indent, "if ", asked(part.condition), ":")
            lines += self._block(indent + 4, part.then)
            if part.otherwise:
                lines += [f"{blank}else:", *self._block(indent + 4, part.otherwise)]
        return lines

    def _cause(self, part: Say | SayUnknown | SayRule | When) -> str:
        match part:
            case Say():
                values = [
                    f"shown({value_text(each, self._layout)})"
                    for each in part.pieces
                    if not isinstance(each, str)
                ]
                return _text(
                    [each if isinstance(each, str) else _PLACE for each in part.pieces], values
                )
            case SayUnknown():
                reads = (
                    f"({term_name(self._program, each)!r}, {value_text(each, self._layout)})"
                    for each in part.terms
                )
                return f"unknown_of({', '.join([repr(part.suffix), *reads])})"
            case SayRule():
                method = (self._layout.why if part.holds else self._layout.why_not)[part.rule]
                return f"because({part.head!r}, self._{method}())"
            case When():
                raise AssertionError("a condition is no cause")


def _tuple_of(causes: list[str]) -> list[str]:
    if len(causes) > 1:
        return lay_out_call(8, "return (", causes)
    line = f"        return ({causes[0]},)"
    if len(line) <= MAX_LINE:
        return [line]
    return ["        return (", f"            {causes[0]},", "        )"]


def _of_self(names: dict[Key, str]) -> dict[Key, str]:
    return {key: f"self._{name}" for key, name in names.items()}


def _asks_for_time(plan: Plan) -> bool:
    """Return whether a condition of a plan compares with the present time."""
    for part in plan:
        if isinstance(part, When):
            inner = walk.parts(part.condition)
            if any(isinstance(each, For | Age) for each in inner):
                return True
            if _asks_for_time(part.then) or _asks_for_time(part.otherwise):
                return True
    return False


def _text(pieces: list[str], values: list[str]) -> str:
    """Return a string literal, with a value in each place."""
    if not values:
        return repr("".join(pieces))
    quoted = repr("".join(each.replace("{", "{{").replace("}", "}}") for each in pieces))
    first, *rest = quoted.split(repr(_PLACE)[1:-1])
    return f"f{first}" + "".join(f"{{{v}}}{t}" for v, t in zip(values, rest, strict=True))
