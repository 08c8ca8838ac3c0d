"""A node that is read from a description of another tool."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace
from typing import Any

from deros import codes
from deros.diagnostics import Code, Diagnostic, SourceFile, Span
from deros.generators.node.description import parameter_line
from deros.importers import node_text
from deros.importers.formats.loading import missing, shown
from deros.importers.formats.names import has_long_word
from deros.importers.results import Missing, Parts
from deros.interfaces.store import InterfaceStore
from deros.interfaces.types import InterfaceType
from deros.models.common import Name, QosProfile
from deros.models.node import NodeType, Parameter, ParameterType, Port, PortKind
from deros.names.names import not_text
from deros.rules.compiler.build_cache import BuildCache
from deros.validators.findings.context import CheckContext
from deros.validators.node.node import check

_OF_DEFAULTS: frozenset[Code] = frozenset(
    {codes.WRONG_DEFAULT, codes.DEFAULT_OUT_OF_RANGE, codes.NO_SUCH_FILE}
)


class Draft:
    """Collects what a description says of a node, and what a model cannot say of it.

    What the checks of node descriptions object to is taken out again, so that the model checks
    clean; the words of the finding say why.

    Attributes:
        missing: what the model does not say.
        takes_any_parameter: whether the node has parameters that are not declared.
    """

    def __init__(self, name: str, package: str) -> None:
        """Start without ports and parameters.

        Args:
            name: of the node type, which a model can have.
            package: likewise.
        """
        self.missing: list[Missing] = []
        self.takes_any_parameter = False
        self._parameters: list[Parameter] = []
        self._ports: list[Port] = []
        self._places: list[Span] = []
        # A value behind an alias has one place in its file for several parameters; here, each
        # parameter and port has a place of its own, so that a finding is about one of them.
        self._marks = SourceFile("", "")
        start = Span(self._marks, 0, 0)
        self._node = NodeType(name, package, self._marks, start, start, start)

    @property
    def node(self) -> NodeType:
        """The node as it is so far."""
        return replace(
            self._node,
            parameters=tuple(self._parameters),
            ports=tuple(self._ports),
            takes_any_parameter=self.takes_any_parameter,
        )

    def lack(self, what: str, why: str, span: Span) -> None:
        """Note what the model does not say of a place in the file."""
        self.missing.append(missing(what, why, span))

    def add_parameter(self, name: str, of_type: ParameterType, span: Span, **more: Any) -> None:
        """Declare a parameter.

        Args:
            name: ``<x>`` in it stands for the entries of list ``x``.
            of_type: its type.
            span: where the file declares it.
            more: what else a :class:`Parameter` has; ``custom`` are names of functions.
        """
        if has_long_word(name):
            self.lack(f"parameter '{name}'", "is left out: its name is too long", span)
            return
        place = self._place(span)
        default = more.pop("default", None)
        custom = tuple(Name(each, place) for each in more.pop("custom", ()))
        description = str(more.pop("description", ""))
        if not_text(description):
            description = shown(description)
        for word, value in (("default", default), ("choices", more.get("choices"))):
            if _has_no_text(value):
                self.lack(f"parameter '{name}'", f"has a {word} here that is not a text", span)
                default = None if word == "default" else default
                more.pop(word, None)
        made = Parameter(
            name,
            of_type,
            default,
            place,
            place,
            custom=custom,
            description=description,
            **more,
        )
        self._parameters.append(made)

    def add_port(
        self,
        kind: PortKind,
        name: str,
        of_type: InterfaceType,
        span: Span,
        qos: QosProfile | None = None,
        description: str = "",
    ) -> None:
        """Declare a port; ``span`` is where the file does so."""
        place = self._place(span)
        description = shown(description) if not_text(description) else description
        made = Port(kind, name, of_type, place, place, place, qos, description=description)
        self._ports.append(made)

    def _place(self, span: Span) -> Span:
        self._places.append(span)
        return Span(self._marks, len(self._places) - 1, len(self._places))

    def clean(self, store: InterfaceStore) -> None:
        """Take out what checks object to."""
        context = CheckContext(store, BuildCache(store))
        while findings := list(check(before := self.node, context)):
            first: dict[int, Diagnostic] = {}
            for each in findings:
                first.setdefault(each.span.start, each)
            self._parameters = list(self._kept_parameters(first))
            self._ports = list(self._kept_ports(first))
            assert self.node != before, [each.message for each in findings]

    def _kept_parameters(self, findings: dict[int, Diagnostic]) -> Iterator[Parameter]:
        for each in self._parameters:
            found = findings.get(each.span.start)
            if found is None:
                yield each
                continue
            kept, verb = _weaker(each, found.code)
            self.lack(f"parameter '{each.name}'", f"{verb}: {found.message}", self._at(each.span))
            if kept is not None:
                yield kept

    def _kept_ports(self, findings: dict[int, Diagnostic]) -> Iterator[Port]:
        for each in self._ports:
            if found := findings.get(each.span.start):
                what = f"{each.kind.word} '{each.name}'"
                self.lack(what, f"is left out: {found.message}", self._at(each.span))
            else:
                yield each

    def _at(self, place: Span) -> Span:
        return self._places[place.start]

    def parts(self, head: str) -> Parts:
        """Return the description, with what is missing in comments."""
        node = self.node
        lines = [f"  {parameter_line(each)}" for each in node.parameters]
        opening = "parameters open" if node.takes_any_parameter else "parameters"
        text = node_text.body(
            lifecycle=node.lifecycle,
            parameters=[opening, *lines] if lines or node.takes_any_parameter else [],
            ports=[
                (
                    each.kind,
                    node_text.port_line(
                        each.kind, each.name, each.type, each.qos, each.description
                    ),
                )
                for each in node.ports
            ],
            left_out=[f"{each.what} {each.why}" for each in self.missing],
        )
        return Parts(head, text)


def _has_no_text(value: object) -> bool:
    texts = value if isinstance(value, tuple) else (value,)
    return any(isinstance(each, str) and not_text(each) is not None for each in texts)


def _weaker(parameter: Parameter, code: Code) -> tuple[Parameter | None, str]:
    """Return a parameter without what a finding objects to, and what that does to it."""
    if code in _OF_DEFAULTS and parameter.default is not None:
        return replace(parameter, default=None), "has no default here"
    if code is codes.BAD_CUSTOM_FUNCTION:
        return replace(parameter, custom=()), "has no function here that checks it"
    bare = replace(
        parameter,
        interval=None,
        choices=None,
        size=None,
        min_size=None,
        max_size=None,
        not_empty=False,
        unique=False,
    )
    if code is codes.BAD_CONSTRAINT and bare != parameter:
        return bare, "has no constraints here"
    return None, "is left out"
