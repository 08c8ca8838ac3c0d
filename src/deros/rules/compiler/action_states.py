"""Conditions that name actions: which one is meant, and that none depends on itself."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from graphlib import CycleError, TopologicalSorter
from itertools import pairwise

from deros import codes
from deros.diagnostics import Related, Span
from deros.models import rules
from deros.names.names import did_you_mean, near
from deros.rules.compiler.scope.mentions import Mention
from deros.rules.compiler.scope.scope import Scope
from deros.rules.program import ir, walk

ACTIVE = "active"
"""What is asked of an action: ``ACTION.active``."""


def hint_at(action: str) -> str:
    """Return the hint how a condition names an action."""
    return f"whether it is active is '{action}.{ACTIVE}'"


class ActionStates:
    """Resolves ``ACTION.active``. An input, a constant or a rule of this name comes first."""

    def __init__(
        self, scope: Scope, actions: Mapping[str, int], is_rule: Callable[[rules.NamePath], bool]
    ) -> None:
        """Look up names in a scope.

        Args:
            scope: of the rules.
            actions: the declared ones, by name.
            is_rule: returns whether ``entity.rule`` is a rule.
        """
        self._scope = scope
        self._actions = actions
        self._is_rule = is_rule

    def asked(self, term: rules.Term) -> rules.NamePath | None:
        """Return the name with which a term alone asks for an action, or seems to."""
        if isinstance(term, rules.Call) and term.receiver is not None and not term.arguments:
            asked = term.receiver if term.function.text == ACTIVE else None
            return asked if isinstance(asked, rules.NamePath) and self._is_action(asked) else None
        return term if isinstance(term, rules.NamePath) and self._is_meant(term) else None

    def _is_meant(self, term: rules.NamePath) -> bool:
        return self._is_action(term) or self._is_misspelt(term)

    def _is_misspelt(self, term: rules.NamePath) -> bool:
        return term.path == (ACTIVE,) and not self._is_other(term) and bool(self._near(term))

    def _is_action(self, term: rules.NamePath) -> bool:
        return term.name.text in self._actions and not self._is_other(term)

    def _is_other(self, term: rules.NamePath) -> bool:
        name = term.name.text
        return name in self._scope.inputs or name in self._scope.constants or self._is_rule(term)

    def _near(self, term: rules.NamePath) -> list[str]:
        return [f"{each}.{ACTIVE}" for each in near(term.name.text, self._actions)]

    def condition(self, asked: rules.NamePath, whole: rules.Term) -> ir.Active | None:
        """Return the condition that an action is active; ``None`` if that is not what is asked.

        A fault has been reported then.
        """
        name = asked.name.text
        if name not in self._actions:
            message = f"no action '{name}' is declared"
            hint = did_you_mean(self._near(asked))
            self._scope.fault(codes.UNKNOWN_NAME, message, asked.span, hint)
            return None
        if whole is not asked or asked.path != (ACTIVE,):
            message = f"'{whole.span.text}' is not a condition: '{name}' is an action"
            self._scope.fault(codes.UNKNOWN_NAME, message, whole.span, hint_at(name))
            return None
        self._scope.mentions.append(Mention("action", name, asked.name.span))
        return ir.Active(self._actions[name], whole.span)


def check_order(scope: Scope, program: ir.Program) -> None:
    """Report each cycle in which the state of an action depends on itself; cut it then."""
    order = _Order(program)
    while cycle := _cycle(order):
        _report(scope, order, cycle)


def _cycle(order: _Order) -> list[_Node]:
    """Return nodes each of which names the next, the last one being the first again, if any."""
    try:
        TopologicalSorter(order.named).prepare()
    except CycleError as error:
        found: list[_Node] = error.args[1][::-1]
        return found
    return []


_Node = tuple[str, int]
"""A rule, an outermost behaviour, or an action, by its index."""


class _Order:
    """What is evaluated after what: of each node those that it depends on, with the place."""

    def __init__(self, program: ir.Program) -> None:
        self._program = program
        self.named: dict[_Node, dict[_Node, Span]] = {}
        self._outer = {
            each.index: ("behaviour", outer.index)
            for outer in program.behaviours
            for each in walk.nested(outer)
        }
        self._names = {each.index: each.name for each in program.behaviours}
        for rule in program.rules:
            self._add(("rule", rule.index), rule.condition, rule.span)
        for outer in program.behaviours:
            for each in walk.nested(outer):
                self._add(("behaviour", outer.index), each.condition, each.span)
                self._add_body(each)

    def _add(self, node: _Node, condition: ir.Condition, span: Span) -> None:
        named = self.named.setdefault(node, {})
        for part in walk.parts(condition):
            if isinstance(part, ir.RuleRef):
                named.setdefault(("rule", part.rule), span)
            elif isinstance(part, ir.Active):
                named.setdefault(("action", part.action), part.span)

    def _add_body(self, behaviour: ir.Behaviour) -> None:
        """Add what a behaviour runs: each action, and those that it resets."""
        for item in behaviour.body:
            if isinstance(item, ir.Trigger):
                reset = (e.index for e in self._program.actions if e.reset_by == item.action)
                for action in (item.action, *reset):
                    named = self.named.setdefault(("action", action), {})
                    named.setdefault(self._outer[behaviour.index], item.span)

    def name(self, node: _Node) -> str:
        kind, index = node
        if kind == "rule":
            return self._program.rules[index].full_name
        return self._names[index] if kind == "behaviour" else self._program.actions[index].name


def _report(scope: Scope, order: _Order, cycle: list[_Node]) -> None:
    """Report a cycle from its first action on, and cut it behind that."""
    first = min(node for node in cycle if node[0] == "action")
    start = cycle.index(first)
    turned = [*cycle[start:-1], *cycle[:start], first]
    steps = list(pairwise(turned))
    path = " -> ".join(map(order.name, turned))
    message = f"whether '{order.name(first)}' is active depends on itself: {path}"
    places = [
        Related(order.named[node][other], _place(order, node, other)) for node, other in steps[:-1]
    ]
    hint = "what triggers or resets an action cannot depend on whether it is active"
    if len(steps) == 2:
        hint += ": write what asks for it as a behaviour of its own"
    *_, (last, _) = steps
    span = order.named[last].pop(first)
    scope.fault(codes.ACTION_CYCLE, message, span, hint, tuple(places))


def _place(order: _Order, node: _Node, other: _Node) -> str:
    if node[0] == "action":
        return f"'{order.name(other)}' triggers or resets '{order.name(node)}' here"
    return f"'{order.name(node)}' depends on '{order.name(other)}' here"
