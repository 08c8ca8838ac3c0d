"""The typed model of safety rules (``*.deros``): the syntax tree, names not yet resolved.

What the rules mean, with names, fields and units resolved, is :mod:`deros.rules.program.ir`.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Literal

from deros.diagnostics import SourceFile, Span
from deros.interfaces.types import InterfaceType
from deros.models.common import Name
from deros.models.system import System
from deros.models.terms import Arithmetic as Arithmetic
from deros.models.terms import ArithmeticOperator as ArithmeticOperator
from deros.models.terms import Boolean as Boolean
from deros.models.terms import Call as Call
from deros.models.terms import NamePath as NamePath
from deros.models.terms import Negative as Negative
from deros.models.terms import Number as Number
from deros.models.terms import String as String
from deros.models.terms import Term as Term
from deros.models.terms import TopicPath as TopicPath

ComparisonOperator = Literal["=", "!=", "<", "<=", ">", ">="]


# Conditions -------------------------------------------------------------------------------------


@dataclass(frozen=True, slots=True)
class Membership:
    """``operand [not] in`` an interval, each end closed or open."""

    operand: Term
    negated: bool
    lower: Term
    upper: Term
    lower_closed: bool
    upper_closed: bool
    span: Span = field(compare=False, repr=False)
    interval_span: Span = field(compare=False, repr=False)


@dataclass(frozen=True, slots=True)
class Comparison:
    """``left OP right``; ``==`` reads as ``=``."""

    left: Term
    operator: ComparisonOperator
    right: Term
    span: Span = field(compare=False, repr=False)


@dataclass(frozen=True, slots=True)
class Truth:
    """A term that stands alone as a condition: a boolean field, ``missing()``, ``unknown()``.

    In the condition of a behaviour, ``entity.rule`` is such a term too: a :class:`NamePath`.
    """

    operand: Term
    span: Span = field(compare=False, repr=False)


@dataclass(frozen=True, slots=True)
class Not:
    """``not`` a condition."""

    operand: Condition
    span: Span = field(compare=False, repr=False)


@dataclass(frozen=True, slots=True)
class And:
    """All of two or more conditions."""

    operands: tuple[Condition, ...]
    span: Span = field(compare=False, repr=False)


@dataclass(frozen=True, slots=True)
class Or:
    """Any of two or more conditions."""

    operands: tuple[Condition, ...]
    span: Span = field(compare=False, repr=False)


@dataclass(frozen=True, slots=True)
class For:
    """``operand for DURATION``."""

    operand: Condition
    duration: Number
    span: Span = field(compare=False, repr=False)


@dataclass(frozen=True, slots=True)
class Since:
    """``operand since cause``: it holds from the cause on, as long as the operand does."""

    operand: Condition
    cause: Condition
    span: Span = field(compare=False, repr=False)


@dataclass(frozen=True, slots=True)
class Once:
    """``operand within DURATION``: the operand holds, or did so less than the duration ago."""

    operand: Condition
    duration: Number
    span: Span = field(compare=False, repr=False)


@dataclass(frozen=True, slots=True)
class Times:
    """``operand COUNT times within DURATION``: it turned true as often in so long a time."""

    operand: Condition
    count: Number
    duration: Number
    span: Span = field(compare=False, repr=False)


@dataclass(frozen=True, slots=True)
class Begins:
    """``operand begins``: the event at which the operand turns true."""

    operand: Condition
    span: Span = field(compare=False, repr=False)


Condition = Comparison | Membership | Truth | Not | And | Or | For | Since | Once | Times | Begins


def operands(condition: Condition) -> tuple[Condition, ...]:
    """Return the conditions that a condition is made of, in the order written."""
    match condition:
        case And() | Or():
            return condition.operands
        case Since():
            return condition.operand, condition.cause
        case Comparison() | Membership() | Truth():
            return ()
        case _:
            return (condition.operand,)


# Declarations -----------------------------------------------------------------------------------


@dataclass(frozen=True, slots=True)
class Use:
    """``use "FILE" import NAME``; ``system`` is ``None`` when it could not be loaded."""

    path: str
    system_name: Name
    system: System | None = field(compare=False, repr=False)
    span: Span = field(compare=False, repr=False)
    path_span: Span = field(compare=False, repr=False)


@dataclass(frozen=True, slots=True)
class UnitDefinition:
    """``unit knot = 0.514444 m/s``."""

    name: Name
    factor: Number
    span: Span = field(compare=False, repr=False)


@dataclass(frozen=True, slots=True)
class Binding:
    """The publication of a bound action: ``publishes VALUE on TOPIC : TYPE``."""

    value: Term
    topic: Name
    type: InterfaceType
    type_span: Span = field(compare=False, repr=False)
    span: Span = field(compare=False, repr=False)


@dataclass(frozen=True, slots=True)
class Action:
    """A declared action: robot code (no ``binding``), or a state that the node publishes."""

    name: Name
    parameters: tuple[Name, ...]
    span: Span = field(compare=False, repr=False)
    binding: Binding | None = None
    reset_by: Name | None = None
    latched: bool = False
    description: str = ""


@dataclass(frozen=True, slots=True)
class TunableIn:
    """``tunable in [0.1, 1.0] m/s``: a safety node sets the constant within this interval.

    ``unit`` follows the interval and is that of both ends; an end may have its own instead.
    """

    lower: Term
    upper: Term
    closed: bool
    span: Span = field(compare=False, repr=False)
    interval_span: Span = field(compare=False, repr=False)
    unit: str | None = None
    unit_span: Span | None = field(default=None, compare=False, repr=False)
    description: str = ""


@dataclass(frozen=True, slots=True)
class Constant:
    """``const NAME = VALUE``; the value is a number, another constant or a conversion of one.

    Of a ``tunable`` one the value is a number, which applies where a node does not set it.
    """

    name: Name
    value: Term
    span: Span = field(compare=False, repr=False)
    tunable: TunableIn | None = None


@dataclass(frozen=True, slots=True)
class Input:
    """``input NAME = topic TOPIC.FIELD [UNIT] no_return N publishers any timeout T``.

    All after the field may be absent. ``no_return`` is the range that a laser scanner reports where
    nothing is there; ``any_publishers``: several nodes are meant to publish the topic.
    """

    name: Name
    term: TopicPath
    span: Span = field(compare=False, repr=False)
    timeout: Number | None = None
    description: str = ""
    unit: str | None = None
    unit_span: Span | None = field(default=None, compare=False, repr=False)
    no_return: Number | None = None
    any_publishers: bool = False


@dataclass(frozen=True, slots=True)
class Rule:
    """``[failsafe] NAME: CONDITION;`` inside an entity.

    A ``failsafe`` one counts as true for the behaviours where it is unknown.
    """

    name: Name
    condition: Condition
    span: Span = field(compare=False, repr=False)
    description: str = ""
    failsafe: bool = False


@dataclass(frozen=True, slots=True)
class Entity:
    """A named group of rules."""

    name: Name
    rules: tuple[Rule, ...]
    span: Span = field(compare=False, repr=False)
    description: str = ""


@dataclass(frozen=True, slots=True)
class ActionCall:
    """``stop;`` or ``log_state("text");`` in the body of a behaviour."""

    action: Name
    arguments: tuple[Term, ...]
    span: Span = field(compare=False, repr=False)


@dataclass(frozen=True, slots=True)
class Behaviour:
    """``[optional] [behaviour NAME:] if CONDITION then { … };``, its body in the order written.

    An ``optional`` one, which has a name, can be switched off while the safety node runs.
    """

    condition: Condition
    body: tuple[ActionCall | Behaviour, ...]
    span: Span = field(compare=False, repr=False)
    name: Name | None = None
    optional: bool = False


# Gates ------------------------------------------------------------------------------------------


@dataclass(frozen=True, slots=True)
class GateLimit:
    """``linear.x to [-0.1, 0.1] m/s``: a field of the command and the interval it is kept in.

    ``unit`` follows the interval and is that of both ends; an end may have its own instead.
    """

    path: tuple[str | int, ...]
    lower: Term
    upper: Term
    lower_closed: bool
    upper_closed: bool
    span: Span = field(compare=False, repr=False)
    path_span: Span = field(compare=False, repr=False)
    interval_span: Span = field(compare=False, repr=False)
    unit: str | None = None
    unit_span: Span | None = field(default=None, compare=False, repr=False)


@dataclass(frozen=True, slots=True)
class StopField:
    """``linear.x 1 m/s2``, a ramp, or ``data = false``, which is sent; none empties an array."""

    path: tuple[str | int, ...]
    value: Term | None
    span: Span = field(compare=False, repr=False)
    path_span: Span = field(compare=False, repr=False)


StopKind = Literal["zero", "send", "hold", "silence"]


@dataclass(frozen=True, slots=True)
class GateStop:
    """What a gate publishes to stop: zeros, along ``ramps``, what ``sent`` says, or the like."""

    kind: StopKind
    span: Span = field(compare=False, repr=False)
    ramps: tuple[StopField, ...] = ()
    sent: tuple[StopField, ...] = ()


@dataclass(frozen=True, slots=True)
class GateLine:
    """One line of a gate: its condition, and its effect on the command.

    It applies while ``action`` is active or, without one, when what ``lost`` names has been silent
    for ``duration``; without either it is a standing one, which always applies. It has either a
    ``stop`` or ``limits``, or it has the gate ``wait`` while the action is active. ``until_reset``:
    the stop lasts until a reset of the gate, however long the line applies.
    """

    action: Name | None
    lost: Literal["heartbeat", "input"] | None
    duration: Number | None
    limits: tuple[GateLimit, ...]
    span: Span = field(compare=False, repr=False)
    until_reset: bool = False
    stop: GateStop | None = None
    wait: Number | None = None

    @property
    def is_standing(self) -> bool:
        """Whether it always applies."""
        return self.action is None and self.lost is None


@dataclass(frozen=True, slots=True)
class Gate:
    """``gate SOURCE -> TARGET : TYPE rate R { … }``: a filter for commands.

    ``resume`` is where ``resume on zero command`` stands, if it does.
    """

    source: Name
    target: Name
    type: InterfaceType
    rate: Number
    lines: tuple[GateLine, ...]
    span: Span = field(compare=False, repr=False)
    type_span: Span = field(compare=False, repr=False)
    description: str = ""
    resume: Span | None = field(default=None, repr=False)


@dataclass(frozen=True, slots=True)
class Rules:
    """A whole DeRoS program. ``name`` is the stem of its file."""

    name: str
    source: SourceFile = field(compare=False, repr=False)
    uses: tuple[Use, ...] = ()
    units: tuple[UnitDefinition, ...] = ()
    actions: tuple[Action, ...] = ()
    constants: tuple[Constant, ...] = ()
    inputs: tuple[Input, ...] = ()
    entities: tuple[Entity, ...] = ()
    behaviours: tuple[Behaviour, ...] = ()
    gates: tuple[Gate, ...] = ()
