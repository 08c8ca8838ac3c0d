"""What may differ between a running graph and a model: the kinds, and one difference."""

from __future__ import annotations

import enum
from dataclasses import dataclass, field
from typing import Literal

from deros.diagnostics import Span
from deros.interfaces.durations import NS_PER_S

Severity = Literal["error", "warning"]

About = Literal["nodes", "ends", "parameters", "state", "container", "graph"]
"""What has to be known of a node to say whether something differs; ``graph``: of several nodes."""


@dataclass(frozen=True, slots=True)
class _Facts:
    word: str
    about: About
    grace_s: float
    severity: Severity


class Kind(enum.Enum):
    """A kind of difference.

    The grace is how long a difference has to last while a graph is watched. It is longer for what
    a restart of a node brings about by itself.
    """

    MISSING_NODE = _Facts("missing-node", "nodes", 5, "error")
    REPEATED_NODE = _Facts("repeated-node", "nodes", 25, "error")  # longer than the usual lease
    RESTARTING_NODE = _Facts(
        "restarting-node", "graph", 0, "error"
    )  # counted over a time of its own
    EXTRA_NODE = _Facts("extra-node", "nodes", 2, "warning")
    WRONG_STATE = _Facts("wrong-state", "state", 10, "error")
    WRONG_CONTAINER = _Facts("wrong-container", "container", 10, "error")
    MISSING_END = _Facts("missing-end", "ends", 5, "error")
    EXTRA_END = _Facts("extra-end", "ends", 2, "warning")
    WRONG_TYPE = _Facts("wrong-type", "ends", 2, "error")
    WRONG_QOS = _Facts("wrong-qos", "ends", 2, "error")
    NOT_CONNECTED = _Facts("not-connected", "graph", 2, "error")
    SECOND_PUBLISHER = _Facts("second-publisher", "graph", 2, "error")
    MISSING_PARAMETER = _Facts("missing-parameter", "parameters", 5, "error")
    WRONG_VALUE = _Facts("wrong-value", "parameters", 1, "error")
    CHANGED_VALUE = _Facts("changed-value", "parameters", 1, "warning")

    @property
    def word(self) -> str:
        """How it is called on the command line and in reports."""
        return self.value.word

    @property
    def about(self) -> About:
        """What has to be known of a node to find it."""
        return self.value.about

    @property
    def severity(self) -> Severity:
        """How serious it is."""
        return self.value.severity

    @property
    def grace_ns(self) -> int:
        """The usual grace, in nanoseconds."""
        return int(self.value.grace_s * NS_PER_S)


KINDS_BY_WORD = {kind.word: kind for kind in Kind}

Key = tuple[Kind, str, str]


@dataclass(frozen=True, slots=True)
class Difference:
    """One difference, and where the model says otherwise.

    Attributes:
        kind: which it is.
        node: the full name of the node that differs.
        subject: the end, as ``publisher /scan``, or the parameter; empty for the node itself.
        expected: what the model says, in words; empty where it says nothing.
        seen: what there is, in words; empty where there is nothing.
        note: what follows from it, or what else is to be known.
        span: where the model says it.
    """

    kind: Kind
    node: str
    subject: str = ""
    expected: str = ""
    seen: str = ""
    note: str = ""
    span: Span | None = field(default=None, compare=False, repr=False)

    @property
    def key(self) -> Key:
        """What tells it from others; what is seen may change while it lasts."""
        return self.kind, self.node, self.subject


@dataclass(frozen=True, slots=True)
class Comparison:
    """The differences of one look.

    Attributes:
        differences: in the order of the kinds, then sorted by node and subject.
        unknown: what could not be compared: the names of nodes, and what of them is not known.
    """

    differences: tuple[Difference, ...]
    unknown: frozenset[tuple[str, About]] = frozenset()
