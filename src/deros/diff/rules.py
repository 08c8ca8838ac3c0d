"""Changes of safety rules (``*.deros``).

Whether a changed condition is weaker is not decided: it is reported with both texts. What breaks is
what certainly protects less, or may do so by what is written: what is gone, times that are longer,
latches and resets that are lost.
"""

from __future__ import annotations

from collections.abc import Hashable, Iterator, Mapping
from dataclasses import dataclass
from functools import partial
from typing import Any

from deros.diagnostics import Span
from deros.diff.changes import (
    Aspect,
    Change,
    PartKind,
    Verdict,
    breaking,
    compare,
    compatible,
    matched,
)
from deros.diff.meanings import Meanings, is_longer, written
from deros.diff.texts import Meant, joined, value_text, yes_or_no
from deros.interfaces.units import UnitRegistry
from deros.models.rules import (
    Action,
    ActionCall,
    Behaviour,
    Constant,
    Entity,
    Gate,
    GateLine,
    Input,
    Rules,
    Zone,
)

_LONGEST_NAME = 60


@dataclass(frozen=True, slots=True)
class Item:
    """A part of rules, ready to be compared.

    Attributes:
        name: by which users know it.
        key: by which it corresponds with one of the other version.
        whole: all that it means, by which parts without a name correspond.
        span: where it is.
        values: by aspect; ``None`` for what it does not have.
    """

    name: str
    key: Hashable
    whole: Hashable
    span: Span
    values: Mapping[str, Any]


# Verdicts ---------------------------------------------------------------------------------------


def _longer(old: Meant | None, new: Meant | None) -> str:
    return "a time is longer: what protects comes later" if is_longer(old, new) else ""


def _timeout(old: Meant | None, new: Meant | None) -> str:
    if old is not None and new is None:
        return "silence is not noticed any more"
    return _longer(old, new)


def _lost(why: str) -> Verdict:
    return lambda old, new: why if old and not new else ""


def _gained(why: str) -> Verdict:
    return lambda old, new: why if new and not old else ""


def _fewer(why: str) -> Verdict:
    def breaks(old: tuple[Meant, ...] | None, new: tuple[Meant, ...] | None) -> str:
        gone = [each for each in old or () if each not in (new or ())]
        return why.format(joined(map(str, gone))) if gone else ""

    return breaks


def _line(old: Meant, new: Meant) -> str:
    if _is_until_reset(old.meaning) and not _is_until_reset(new.meaning):
        return "the stop ends without a reset"
    return _longer(old, new)


def _is_until_reset(meaning: Any) -> bool:
    return ("until_reset", True) in meaning


# Kinds of parts ---------------------------------------------------------------------------------

_DESCRIPTION: dict[str, Verdict] = {"description": compatible}


def _kind(word: str, aspects: Mapping[str, Verdict], removed: str = "") -> PartKind[Item]:
    return PartKind(
        word,
        lambda item: item.name,
        lambda item: item.span,
        [
            Aspect(name, partial(_value, name), verdict, _said)
            for name, verdict in {**aspects, **_DESCRIPTION}.items()
        ],
        lambda item: "" if word == "behaviour" else written(item.span),
        removed=lambda _: removed,
        keys=(lambda item: (item.key, item.whole), lambda item: item.key),
    )


def _value(name: str, item: Item) -> Any:
    return item.values.get(name)


def _said(value: Any) -> str:
    if isinstance(value, bool):
        return yes_or_no(value)
    if isinstance(value, tuple):
        return joined(map(str, value))
    return value_text(value) if isinstance(value, str) else str(value)


_READERS = "those who subscribe to its state"
_KINDS: dict[str, PartKind[Item]] = {
    "system": _kind("system", {}),
    "unit": _kind("unit", {"value": compatible}),
    "constant": _kind(
        "constant",
        {
            "value": _longer,
            "tunable": lambda old, _: (
                "" if old is None else "values that safety nodes set may be refused"
            ),
        },
    ),
    "input": _kind(
        "input",
        {
            "source": compatible,
            "unit": compatible,
            "timeout": _timeout,
            "no_return": compatible,
            "mounted": compatible,
            "several publishers": compatible,
            "unknown on second publisher": _lost("a second publisher is not noticed any more"),
        },
    ),
    "zone": _kind("zone", {"shape": compatible}),
    "rule": _kind(
        "rule",
        {
            "condition": _longer,
            "failsafe": _lost("where it is unknown, it does not count as true any more"),
        },
        "what it protects from is not looked at any more",
    ),
    "action": _kind(
        "action",
        {
            "parameters": breaking("the robot's code for it takes others"),
            "publishes": lambda old, _: "" if old is None else _READERS,
            "calls": lambda old, _: "" if old is None else "the service is called otherwise",
            "reset_by": compatible,
            "latched": _lost("it ends without a reset"),
        },
        "nothing triggers it any more: those who react to it",
    ),
    "behaviour": _kind(
        "behaviour",
        {
            "condition": _longer,
            "actions": _fewer("it does not trigger any more: {}"),
            "body": _longer,
            "optional": _gained("it can be switched off while the safety node runs"),
        },
        "what it does is not done any more",
    ),
    "gate": _kind(
        "gate",
        {
            "type": breaking("those who command and the robot use another type"),
            "sources": _fewer("commands are not let through, or not in the same way: {}"),
            "rate": compatible,
            "resume on zero command": _lost("it resumes without a zero command"),
        },
        "commands reach the robot unchecked, or not at all",
    ),
    "gate line": _kind("gate line", {"effect": _line}, "the gate does not do it any more"),
}


# Parts ------------------------------------------------------------------------------------------


class _Side:
    """The parts of one version of rules."""

    def __init__(self, rules: Rules) -> None:
        self._rules = rules
        self._meanings = Meanings(UnitRegistry(rules.own_units))

    def items(self) -> dict[str, list[Item]]:
        """Return all parts by their kinds."""
        rules, meant = self._rules, self._meanings.meant
        return {
            "system": [_item(str(u.system_name), u.span) for u in rules.uses],
            "unit": [_item(str(u.name), u.span, value=meant(u.factor)) for u in rules.units],
            "constant": list(map(self._constant, rules.constants)),
            "input": list(map(self._input, rules.inputs)),
            "zone": list(map(self._zone, rules.zones)),
            "rule": [item for entity in rules.entities for item in self._rules_of(entity)],
            "action": list(map(self._action, rules.actions)),
            "behaviour": list(map(self._behaviour, rules.behaviours)),
            "gate": list(map(self._gate, rules.gates)),
            "gate line": [self._line(gate, line) for gate in rules.gates for line in gate.lines],
        }

    def _constant(self, constant: Constant) -> Item:
        meant, tunable = self._meanings.meant, constant.tunable
        return _item(
            str(constant.name),
            constant.span,
            value=meant(constant.value),
            tunable=meant(tunable),
            description="" if tunable is None else tunable.description,
        )

    def _input(self, found: Input) -> Item:
        return _item(
            str(found.name),
            found.span,
            description=found.description,
            source=self._meanings.meant(found.term),
            unit=self._meanings.unit(found.unit),
            timeout=self._meanings.meant(found.timeout),
            no_return=self._meanings.meant(found.no_return),
            mounted=self._meanings.mounting(found.mounting),
            **{
                "several publishers": found.any_publishers,
                "unknown on second publisher": found.needs_one_publisher,
            },
        )

    def _zone(self, zone: Zone) -> Item:
        return _item(
            str(zone.name),
            zone.span,
            description=zone.description,
            shape=self._meanings.zone(zone),
        )

    def _rules_of(self, entity: Entity) -> Iterator[Item]:
        for rule in entity.rules:
            yield _item(
                f"{entity.name}.{rule.name}",
                rule.span,
                description=rule.description,
                condition=self._meanings.meant(rule.condition),
                failsafe=rule.failsafe,
            )

    def _action(self, action: Action) -> Item:
        return _item(
            str(action.name),
            action.span,
            description=action.description,
            parameters=tuple(map(str, action.parameters)),
            publishes=self._meanings.meant(action.binding),
            calls=self._meanings.meant(action.service),
            reset_by=None if action.reset_by is None else str(action.reset_by),
            latched=action.latched,
        )

    def _behaviour(self, behaviour: Behaviour) -> Item:
        condition = self._meanings.meant(behaviour.condition)
        whole = self._meanings.meant(behaviour)
        assert whole is not None
        named = behaviour.name is not None
        name = str(behaviour.name) if named else _shortened(f"if {condition}")
        return _item(
            name,
            behaviour.span,
            key=name if named else None,
            whole=whole.meaning,
            condition=condition,
            actions=tuple(self._calls(behaviour)),
            body=Meant(whole.text.partition("then")[2].strip(), self._meanings.of(behaviour.body)),
            optional=behaviour.optional,
        )

    def _calls(self, behaviour: Behaviour) -> Iterator[Meant]:
        for part in behaviour.body:
            if isinstance(part, ActionCall):
                yield Meant(str(part.action), str(part.action))
            else:
                yield from self._calls(part)

    def _gate(self, gate: Gate) -> Item:
        return _item(
            str(gate.target),
            gate.span,
            description=gate.description,
            type=gate.type.short,
            sources=tuple(
                Meant(_source_text(each), self._meanings.of(each)) for each in gate.sources
            ),
            rate=self._meanings.meant(gate.rate),
            **{"resume on zero command": gate.resume is not None},
        )

    def _line(self, gate: Gate, line: GateLine) -> Item:
        name = "always" if line.is_standing else str(line.action or f"lost {line.lost}")
        key = (str(gate.target), name, line.wait is not None, bool(line.limits))
        effect = self._meanings.meant(line)
        assert effect is not None
        return _item(
            f"{gate.target}: {name}", line.span, key=key, whole=effect.meaning, effect=effect
        )


def _source_text(source: Any) -> str:
    duration = "" if source.duration is None else f" for {written(source.duration.span)}"
    return f"{source.topic}{duration}{' from zero' * source.from_zero}"


def _item(
    name: str,
    span: Span,
    *,
    key: Hashable = "",
    whole: Hashable = None,
    **values: Any,
) -> Item:
    return Item(name, name if key == "" else key, whole, span, values)


def _shortened(text: str) -> str:
    return text if len(text) <= _LONGEST_NAME else f"{text[: _LONGEST_NAME - 1]}…"


def compare_rules(old: Rules, new: Rules) -> Iterator[Change]:
    """Yield the changes from one version of rules to another."""
    before, after = _Side(old).items(), _Side(new).items()
    for word, kind in _KINDS.items():
        yield from compare(kind, before[word], after[word])
    yield from _order(before["behaviour"], after["behaviour"])


def _order(old: list[Item], new: list[Item]) -> Iterator[Change]:
    """Yield the change if behaviours act in another order, which counts where they meet."""
    pairs, _, _ = matched(_KINDS["behaviour"].keys, old, new)
    places = {id(item): place for place, item in enumerate(new)}
    turned = sorted(pairs, key=lambda pair: places[id(pair[1])])
    if turned != pairs:
        before, after = (joined(item.name for item, _ in found) for found in (pairs, turned))
        spans = pairs[0][0].span, turned[0][1].span
        yield Change("changed", "behaviours", "all", "order", before, after, spans[0], spans[1])
