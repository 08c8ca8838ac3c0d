"""How the steps of a gate become text: one rule for each kind of step, in each language."""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Callable, Iterable, Sequence
from typing import TYPE_CHECKING, Any

from deros import codes
from deros.diagnostics import Span, report
from deros.generators.api.protocol import GenerationError
from deros.generators.gate.view import GateBase
from deros.generators.text.identifiers import snake_case
from deros.monitor import gate_program as form

if TYPE_CHECKING:
    from jinja2 import Template

Printer = Callable[[Iterable[form.Step | form.Variable]], str]
"""Prints steps, or variables; raises :class:`GenerationError` for one that has no rule."""


def step_printer(rules: Template, span: Span, language: str, **names: Any) -> Printer:
    """Return a printer of steps, or of variables.

    Args:
        rules: a template with a macro for each kind of step, by the name of its class.
        span: where the gate is, for refusals.
        language: that of the rules, for refusals.
        names: what the macros refer to.
    """
    macros = rules.make_module(names)

    def printed(steps: Iterable[form.Step | form.Variable]) -> str:
        lines: list[str] = []
        for step in steps:
            macro = getattr(macros, snake_case(type(step).__name__), None)
            if macro is None:
                raise unsupported(step, language, span)
            lines.append(macro(step))
        return "".join(lines).removesuffix("\n")

    return printed


class ConditionPrinter(ABC):
    """Prints the conditions of one gate.

    Attributes:
        language: the name of the language.
        all_of, any_of: what stands between the operands.
        never: the condition that never holds.
    """

    language: str
    all_of: str
    any_of: str
    never: str

    def __init__(self, gate: GateBase) -> None:
        """Print conditions of ``gate``."""
        self._gate = gate

    @abstractmethod
    def variable(self, name: str) -> str:
        """Return how a variable of the gate is spelt."""

    @abstractmethod
    def nanoseconds(self, count: int) -> str:
        """Return the literal of a duration."""

    @abstractmethod
    def losses(self, sources: Sequence[form.Source]) -> list[str]:
        """Return the conditions one of which holds if one of ``sources`` is lost."""

    @abstractmethod
    def none_of(self, operands: list[str]) -> str:
        """Return the condition, as an operand of ``all_of``, that none of the operands holds."""

    def instant(self, source: form.Source, ns: int) -> str:
        """Return when a source will have been silent for ``ns``."""
        return f"{self.variable(source)} + {self.nanoseconds(ns)}"

    def __call__(self, condition: form.Condition) -> str:
        """Return the text of a condition."""
        operands = self._alternatives(condition)
        if operands is not None:
            return self.any_of.join(operands) or self.never
        match condition:
            case form.AllOf(parts):
                return self.all_of.join(map(self.operand, parts))
            case form.Not(operand):
                return self.none_of(self._alternatives(operand) or [self(operand)])
            case form.Silent(source, ns):
                return f"t >= {self.instant(source, ns)}"
            case form.IsActive(action):
                return self.variable(self._gate.state(action))
            case form.Applies(line):
                return self._gate.lines[line].name
            case form.IsLatched(line):
                return self.variable(self._gate.lines[line].latch)
            case form.IsAnyLatched():
                return "is_latched"
            case form.IsZero():
                return "zero"
            case form.IsWaiting():
                return self.variable("waits")
            case _:
                raise unsupported(condition, self.language, self._gate.span)

    def operand(self, condition: form.Condition) -> str:
        """Return a condition as an operand of ``all_of``."""
        operands = self._alternatives(condition) or ()
        return f"({self(condition)})" if len(operands) > 1 else self(condition)

    def _alternatives(self, condition: form.Condition) -> list[str] | None:
        if isinstance(condition, form.AnyOf):
            return list(map(self, condition.operands))
        return self.losses(condition.sources) if isinstance(condition, form.IsLost) else None


def unsupported(element: object, language: str, span: Span) -> GenerationError:
    """Return the refusal of a step or a condition that a language has no rule for."""
    message = f"the gate needs {type(element).__name__}, which does not exist in {language}"
    return GenerationError([report(codes.UNSUPPORTED_BY_TARGET, message, span)])
