"""The monitor's intermediate form: rules with every name, field and unit resolved.

It is the one thing that the reference engine and every generated target read. Times are integer
nanoseconds. Conditions have Kleene's three values; a value expression is a number, a boolean or a
string, or unknown (``None`` in the engine). Unit conversion has been done: constants stand in the
unit of the field they are compared with.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import ClassVar, Literal

from deros.diagnostics import Span
from deros.interfaces.types import InterfaceType
from deros.rules.program.gate_lines import Gate as Gate
from deros.rules.program.gate_lines import GateLine as GateLine
from deros.rules.program.gate_lines import InputBound as InputBound
from deros.rules.program.gate_lines import Limit as Limit
from deros.rules.program.gate_lines import Source as Source
from deros.rules.program.gate_lines import Stop as Stop
from deros.rules.program.gate_lines import StopField as StopField
from deros.rules.program.gate_lines import TunedBound as TunedBound
from deros.rules.program.operators import FOR, SINCE, TIMES, WITHIN, TemporalOperator
from deros.rules.program.values import PUBLISHER as PUBLISHER
from deros.rules.program.values import RECEIPT as RECEIPT
from deros.rules.program.values import Active as Active
from deros.rules.program.values import Apply as Apply
from deros.rules.program.values import Compute as Compute
from deros.rules.program.values import Const as Const
from deros.rules.program.values import Input as Input
from deros.rules.program.values import Leaf as Leaf
from deros.rules.program.values import Read as Read
from deros.rules.program.values import Scalar as Scalar
from deros.rules.program.values import Scale as Scale
from deros.rules.program.values import Tuned as Tuned
from deros.rules.program.values import ValueExpression as ValueExpression
from deros.rules.program.zones import Shape as Shape
from deros.rules.program.zones import Zone as Zone
from deros.systems.tunables import TunableConstant as TunableConstant

Operator = Literal["=", "!=", "<", "<=", ">", ">="]

OPPOSITE: dict[Operator, Operator] = {
    "=": "!=",
    "!=": "=",
    "<": ">=",
    "<=": ">",
    ">": "<=",
    ">=": "<",
}
"""The operator that holds where another one does not, of numbers that are known."""

MIRRORED: dict[Operator, Operator] = {
    "=": "=",
    "!=": "!=",
    "<": ">",
    "<=": ">=",
    ">": "<",
    ">=": "<=",
}
"""The operator that means the same when its operands change sides."""


# Conditions -------------------------------------------------------------------------------------


@dataclass(frozen=True, slots=True)
class Truth:
    """A boolean value as a condition."""

    operand: ValueExpression


@dataclass(frozen=True, slots=True)
class Wording:
    """How people read a comparison, as its author wrote it; it has no part in what it means.

    Attributes:
        operator: before whatever bringing a bound to an integer made of it.
        unit: of the value on the left, where another one stands on the right; else empty.
        right: the right side, or the ends of the interval: a constant as text with its unit, of
            another value the unit, or nothing.
        brackets: of the interval.
    """

    operator: Operator
    unit: str
    right: tuple[str, ...]
    brackets: str = ""


@dataclass(frozen=True, slots=True)
class Compare:
    """A comparison of two values of one kind."""

    left: ValueExpression
    operator: Operator
    right: ValueExpression
    wording: Wording | None = field(default=None, compare=False, repr=False)


@dataclass(frozen=True, slots=True)
class Within:
    """Whether a number lies in an interval. ``not in`` is :class:`Not` of it."""

    operand: ValueExpression
    lower: ValueExpression
    upper: ValueExpression
    lower_closed: bool
    upper_closed: bool
    wording: Wording | None = field(default=None, compare=False, repr=False)


@dataclass(frozen=True, slots=True)
class Missing:
    """Whether an input's timeout has passed; never unknown."""

    input: int


@dataclass(frozen=True, slots=True)
class Unknown:
    """Whether a value is unknown, for whatever reason; never itself unknown.

    It is that of a function of an input or, without ``operand``, of the input itself. While the
    input is awaited (see :class:`Input`) it is false: then nothing is late yet. The input has a
    timeout.
    """

    input: int
    operand: Apply | None = None


@dataclass(frozen=True, slots=True)
class Age:
    """The time since an input's last counted message, compared with a constant.

    Unknown before the first message, and again after a backward clock step; known otherwise,
    whatever NaN or the timeout do to the input's value. ``age > T`` is first true at
    last + T + 1 ns, ``age >= T`` at last + T: both instants are deadlines.
    """

    input: int
    operator: Operator
    bound_ns: int
    wording: Wording | None = field(default=None, compare=False, repr=False)


@dataclass(frozen=True, slots=True)
class Frequency:
    """Whether the messages of an input come too seldom; never unknown.

    It is true where at least ``elapsed_ns``, one or more, have passed since the ``messages``-th
    last message that counted. Before so many have come since the start, or since a backward step of
    the clock, the start (with the grace) or the step stands for each that is lacking. The instant
    at which it turns true is a deadline.
    """

    input: int
    messages: int
    elapsed_ns: int
    wording: Wording | None = field(default=None, compare=False, repr=False)


@dataclass(frozen=True, slots=True)
class Not:
    """Kleene's negation."""

    operand: Condition


@dataclass(frozen=True, slots=True)
class And:
    """Kleene's conjunction of two or more."""

    operands: tuple[Condition, ...]


@dataclass(frozen=True, slots=True)
class Or:
    """Kleene's disjunction of two or more."""

    operands: tuple[Condition, ...]


@dataclass(frozen=True, slots=True)
class For:
    """True once the operand has been true without a break for ``duration_ns`` (inclusive).

    An operand that is false or unknown clears the interval, and the whole is then false or unknown
    as the operand is; while the operand is true but the time has not passed, the whole is false.
    """

    row: ClassVar[TemporalOperator] = FOR
    index: int  # its place among all temporal conditions of the program, as they are evaluated
    operand: Condition
    duration_ns: int
    span: Span = field(compare=False, repr=False)
    wording: str = field(default="", compare=False, repr=False)  # the duration, as written


@dataclass(frozen=True, slots=True)
class Once:
    """True while the operand is, and for ``duration_ns`` from the event at which it ceased to be.

    When they are over, by a deadline, it is false or unknown as the operand is.
    """

    row: ClassVar[TemporalOperator] = WITHIN
    index: int  # its place among all temporal conditions of the program, as they are evaluated
    operand: Condition
    duration_ns: int
    span: Span = field(compare=False, repr=False)
    wording: str = field(default="", compare=False, repr=False)  # the duration, as written


@dataclass(frozen=True, slots=True)
class Times:
    """True while the operand's last ``count`` turns lie less than ``duration_ns`` back.

    It turns at each event at which it is true and was not at the event before. When the first of
    them is over, by a deadline, the whole is false, or unknown where the operand is.
    """

    row: ClassVar[TemporalOperator] = TIMES
    index: int  # its place among all temporal conditions of the program, as they are evaluated
    operand: Condition
    count: int
    duration_ns: int
    span: Span = field(compare=False, repr=False)


@dataclass(frozen=True, slots=True)
class Since:
    """``cause or (operand and before)``, where *before* is its own verdict at the last event.

    At the start, and after a backward step of the clock, *before* is false. While one of ``inputs``
    has had no message that counts since then, a cause that is unknown counts as false for *before*:
    no message of another topic can make it unknown. ``inputs`` are those whose values or ages the
    cause reads. An event that changes neither the cause nor the operand does not change it.
    """

    row: ClassVar[TemporalOperator] = SINCE
    index: int  # its place among all temporal conditions of the program, as they are evaluated
    operand: Condition
    cause: Condition
    inputs: tuple[int, ...]
    span: Span = field(compare=False, repr=False)
    wording: str = field(default="", compare=False, repr=False)  # the cause, as written


@dataclass(frozen=True, slots=True)
class Begins:
    """True at the event at which its condition turns true, and for one nanosecond from there.

    ``operand`` is that condition with ``for`` the shortest time there is: that it has lasted so
    long is what makes this false. It is unknown where the condition is.
    """

    operand: For


@dataclass(frozen=True, slots=True)
class Failsafe:
    """The condition of a rule that counts as true where it is unknown.

    ``inputs`` are those whose values or ages it reads, each with a timeout. While one of them is
    awaited (see :class:`Input`), the whole stays unknown as its operand is.
    """

    operand: Condition
    inputs: tuple[int, ...]


@dataclass(frozen=True, slots=True)
class RuleRef:
    """The verdict of an entity's rule at the same event, in the condition of a behaviour or rule.

    Of a failsafe rule it is what behaviours see: true where its condition is unknown. A rule names
    only rules with smaller indices.
    """

    rule: int


Temporal = For | Once | Times | Since
"""A condition that remembers: ``row`` says what."""

Condition = (
    Truth
    | Compare
    | Within
    | Missing
    | Unknown
    | Age
    | Frequency
    | Not
    | And
    | Or
    | For
    | Once
    | Times
    | Since
    | Begins
    | Failsafe
    | RuleRef
    | Active
)


# The program ------------------------------------------------------------------------------------


@dataclass(frozen=True, slots=True)
class Rule:
    """A rule of an entity; ``early_of`` numbers the one that it is the early rule of."""

    index: int
    entity: str
    name: str
    condition: Condition
    span: Span = field(compare=False, repr=False)
    early_of: int | None = None

    @property
    def full_name(self) -> str:
        """``entity.rule``."""
        return f"{self.entity}.{self.name}"


@dataclass(frozen=True, slots=True)
class Trigger:
    """Run one action with its arguments."""

    action: int
    arguments: tuple[Scalar, ...]
    span: Span = field(compare=False, repr=False)


@dataclass(frozen=True, slots=True)
class Behaviour:
    """Acts when its condition turns true while the enclosing one (``parent``) holds.

    ``index`` numbers all behaviours in the order written, outer before inner; ``name`` is the given
    name or ``behaviour_N`` (N from 1). An ``optional`` one can be disabled at run time: its
    condition then counts as false, while the intervals in it go on being evaluated. So does that of
    one that is ``switched_by`` others. ``early_of`` is the index of the behaviour that this one is
    the early one of (:mod:`deros.rules.engine.early`).
    """

    index: int
    name: str
    condition: Condition
    body: tuple[Trigger | Behaviour, ...]
    parent: int | None
    span: Span = field(compare=False, repr=False)
    optional: bool = False
    switched_by: tuple[int, ...] = ()
    early_of: int | None = None

    @property
    def switches(self) -> tuple[int, ...]:
        """The optional behaviours that have to be enabled, this one among them."""
        return (self.index,) if self.optional else self.switched_by


@dataclass(frozen=True, slots=True)
class Binding:
    """What a bound action publishes while active: ``value`` in the field ``path`` of the message.

    For a boolean field the inactive state is published as the opposite value; for others the
    inactive message has the field's default.
    """

    topic: str
    type: InterfaceType
    path: tuple[str, ...]
    value: Scalar


@dataclass(frozen=True, slots=True)
class ServiceCall:
    """The service that a bound action calls from its trigger until it answers success.

    The ``field`` of the request has the ``value``; both are ``None`` if the request is empty.
    """

    service: str
    type: InterfaceType
    field: str | None = None
    value: Scalar | None = None


@dataclass(frozen=True, slots=True)
class Action:
    """An action; ``log_state`` is built in and has the reserved name ``log_state``."""

    index: int
    name: str
    parameters: tuple[str, ...]
    binding: Binding | None
    reset_by: int | None
    latched: bool
    triggered_by: tuple[int, ...]  # the behaviours whose bodies name it; then their early ones
    span: Span | None = field(default=None, compare=False, repr=False)
    service: ServiceCall | None = None

    @property
    def is_bound(self) -> bool:
        """Whether the safety node carries it out itself: publishes its state, calls a service."""
        return self.binding is not None or self.service is not None


# Gates ------------------------------------------------------------------------------------------


@dataclass(frozen=True, slots=True)
class Program:
    """Everything a monitor does, and the gates that act on it."""

    name: str
    leaves: tuple[Leaf, ...]
    inputs: tuple[Input, ...]
    rules: tuple[Rule, ...]
    behaviours: tuple[Behaviour, ...]  # the outermost ones; nested ones stand in their bodies
    actions: tuple[Action, ...]
    gates: tuple[Gate, ...] = ()
    tunables: tuple[TunableConstant, ...] = ()

    @property
    def topics(self) -> dict[str, InterfaceType]:
        """The topics read, in the order of their first input."""
        return {each.topic: each.type for each in self.inputs}
