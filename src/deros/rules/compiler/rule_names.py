"""Rules that name other rules: what a name refers to, and the order of evaluation."""

from __future__ import annotations

import heapq
import itertools
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from graphlib import CycleError, TopologicalSorter

from deros import codes
from deros.diagnostics import Related
from deros.models import rules
from deros.names.names import did_you_mean, near
from deros.rules.compiler.scope.mentions import Mention
from deros.rules.compiler.scope.scope import Scope


@dataclass(frozen=True, slots=True)
class WrittenRule:
    """A rule, and the name of the entity that it belongs to."""

    entity: str
    rule: rules.Rule

    @property
    def full_name(self) -> str:
        """``entity.rule``."""
        return f"{self.entity}.{self.rule.name}"


class RuleNames:
    """The rules of all entities by name. Their numbers are their places in the file, from 0.

    In the condition of a rule, ``entity.rule`` is any rule, and ``rule`` one of the same entity. An
    input or a constant of the same name comes first.

    Attributes:
        written: all rules in the order written.
    """

    def __init__(self, scope: Scope, entities: Sequence[rules.Entity]) -> None:
        """Report names that are declared twice; the first one counts."""
        self._scope = scope
        self._by_name: dict[str, dict[str, int]] = {}
        self.written: list[WrittenRule] = []
        scope.check_duplicates((each.name for each in entities), "entity '{}'")
        for entity in entities:
            name = entity.name.text
            scope.check_duplicates((each.name for each in entity.rules), f"rule '{name}.{{}}'")
            known = self._by_name.setdefault(name, {})
            for rule in entity.rules:
                known.setdefault(rule.name.text, len(self.written))
                self.written.append(WrittenRule(name, rule))

    # References ---------------------------------------------------------------------------------

    def is_reference(self, term: rules.NamePath, entity: str) -> bool:
        """Return whether a name in a condition of an entity's rule is that of a rule, or means one.

        With a wrong rule of an entity it is one too, and :meth:`find` reports it.
        """
        name = term.name.text
        if name in self._scope.inputs or name in self._scope.constants:
            return False
        return name in self._by_name if term.path else name in self._by_name[entity]

    def is_known(self, term: rules.NamePath) -> bool:
        """Return whether ``entity.rule`` is the full name of a rule."""
        return bool(term.path) and self._number(term, "") is not None

    def find(self, term: rules.NamePath, entity: str = "") -> int | None:
        """Return the rule that a name refers to, within an entity if one is given.

        ``None`` means that a fault has been reported.
        """
        number = self._number(term, entity)
        if number is None:
            self._report(term)
        else:
            name = self.written[number].full_name
            self._scope.mentions.append(Mention("rule", name, term.span))
        return number

    def _number(self, term: rules.NamePath, entity: str) -> int | None:
        if not term.path:
            return self._by_name.get(entity, {}).get(term.name.text)
        known = self._by_name.get(term.name.text, {})
        return known.get(str(term.path[0])) if len(term.path) == 1 else None

    def _report(self, term: rules.NamePath) -> None:
        name = term.name.text
        known = self._by_name.get(name)
        if known is None:
            owners = [
                f"{entity}.{name}" for entity in self._by_name if name in self._by_name[entity]
            ]
            hint = did_you_mean(owners or near(name, self._by_name))
            place = term.span if owners else term.name.span
            self._scope.fault(codes.UNKNOWN_NAME, f"no entity '{name}'", place, hint)
            return
        rule = str(term.path[0]) if term.path else ""
        hint = did_you_mean(f"{name}.{each}" for each in near(rule, known) or list(known)[:3])
        message = f"entity '{name}' has no rule '{'.'.join(map(str, term.path))}'"
        if not term.path:
            message = f"'{name}' is an entity, its rules are the conditions"
        self._scope.fault(codes.UNKNOWN_NAME, message, term.span, hint)

    # Order --------------------------------------------------------------------------------------

    def in_order(self) -> list[int]:
        """Return the rules in the order of evaluation: as written, but after those they name.

        Rules that name one another in a cycle are reported; each cycle is cut then.
        """
        named = {number: self._named(number) for number in range(len(self.written))}
        while True:
            sorter = TopologicalSorter({number: each.keys() for number, each in named.items()})
            try:
                sorter.prepare()
            except CycleError as error:
                # Each rule of the list is named by the next; the last one is the first again.
                cycle: list[int] = error.args[1][::-1]
                self._report_cycle(cycle, named)
                del named[cycle[0]][cycle[1]]
                continue
            return list(_sorted(sorter))

    def _named(self, number: int) -> dict[int, rules.NamePath]:
        """Return the rules that a rule names, each with the first place where it does."""
        written = self.written[number]
        found: dict[int, rules.NamePath] = {}
        for term in names_alone(written.rule.condition):
            if self.is_reference(term, written.entity):
                other = self._number(term, written.entity)
                if other is not None:
                    found.setdefault(other, term)
        return found

    def _report_cycle(self, cycle: list[int], named: dict[int, dict[int, rules.NamePath]]) -> None:
        first = min(cycle)
        turned = [*cycle[cycle.index(first) : -1], *cycle[: cycle.index(first)], first]
        names = [self.written[each].full_name for each in turned]
        message = f"rule '{names[0]}' depends on itself"
        if len(names) > 2:
            message += f": {' -> '.join(names)}"
        places = [
            Related(named[each][other].span, f"'{self.written[each].full_name}' names it here")
            for each, other in itertools.pairwise(turned[1:])
        ]
        hint = "a rule may name rules that do not depend on it"
        span = named[turned[0]][turned[1]].span
        self._scope.fault(codes.RULE_CYCLE, message, span, hint, related=tuple(places))


def _sorted(sorter: TopologicalSorter[int]) -> Iterator[int]:
    """Yield the nodes of a prepared graph; of those that are ready, the least."""
    ready: list[int] = []
    while sorter.is_active():
        for node in sorter.get_ready():
            heapq.heappush(ready, node)
        node = heapq.heappop(ready)
        yield node
        sorter.done(node)


def names_alone(condition: rules.Condition) -> Iterator[rules.NamePath]:
    """Yield the names that stand alone in a condition, as those of rules do."""
    for leaf in rules.leaves(condition):
        if isinstance(leaf, rules.Truth) and isinstance(leaf.operand, rules.NamePath):
            yield leaf.operand
