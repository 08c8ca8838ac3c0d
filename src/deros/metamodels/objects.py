"""The objects of a textX model, made from a parse tree in one pass.

textX asks of every node of a parse tree what kind of rule it is, where it stands by line and
column, and walks the finished model twice more. Here each rule of the grammar has a function that
is made once. The objects are the very same: instances of textX's classes with the same attributes,
positions and parents. What the grammars here do not use (base types, processors, user classes) is
refused when the functions are made.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, NamedTuple

from arpeggio import Match, NonTerminal, ParsingExpression
from textx.const import (
    MULT_ONEORMORE,
    MULT_ZEROORMORE,
    RULE_ABSTRACT,
    RULE_COMMON,
    RULE_MATCH,
)
from textx.lang import BASE_TYPE_NAMES

from deros.metamodels.grammar import expressions
from deros.metamodels.scoping import SCOPE_PROVIDERS

_LISTS = (MULT_ONEORMORE, MULT_ZEROORMORE)
_ASSIGNMENT = "__asgn"
_SEPARATOR = "sep"
_Make = Callable[[Any, Any, "list[_Named]"], Any]
"""Makes the value of a node; given are its parent and the references found so far."""


class _Named(NamedTuple):
    """A name in a model that stands for an element of another file."""

    element: Any
    attribute: str
    obj_name: str


class Objects:
    """Makes the models of one grammar from its parse trees."""

    def __init__(self, grammar: ParsingExpression) -> None:
        """Make the functions of all rules of the grammar.

        Raises:
            TypeError: the grammar uses what has no function here.
        """
        self._makers: dict[int, _Make] = {}
        for rule in expressions(grammar):
            if rule.root:
                self._makers[id(rule)] = self._maker(rule)
            elif isinstance(rule, Match):
                self._makers[id(rule)] = _text

    def model(self, tree: Any, before_references: Callable[[Any], None] | None = None) -> Any:
        """Return the model of a parse tree.

        Args:
            tree: of a whole text.
            before_references: called with the model before its references are resolved.
        """
        references: list[_Named] = []
        whole = tree[0]  # behind it is the end of the file
        model = self._makers[id(whole.rule)](whole, None, references)
        if before_references is not None:
            before_references(model)
        for each in references:
            owner = f"{type(each.element).__name__}.{each.attribute}"
            found = SCOPE_PROVIDERS[owner](each.element, None, each)
            setattr(each.element, each.attribute, found)
        return model

    def _maker(self, rule: ParsingExpression) -> _Make:
        if rule.rule_name in BASE_TYPE_NAMES:
            raise TypeError(f"no objects for the base type {rule.rule_name}")
        if rule.rule_name.startswith(_ASSIGNMENT):
            return _text  # its element takes it apart
        kind = getattr(getattr(rule, "_tx_class", None), "_tx_type", RULE_MATCH)
        if kind == RULE_COMMON:
            return self._element(rule._tx_class)
        if kind == RULE_ABSTRACT:
            return self._one_of
        return _text

    def _one_of(self, node: Any, parent: Any, references: list[_Named]) -> Any:
        """Make what an abstract rule stands for: the element in it."""
        for each in node:
            if len(node) == 1 or isinstance(each, NonTerminal):
                return self._makers[id(each.rule)](each, parent, references)
        return "".join(map(str, node))

    def _element(self, cls: Any) -> _Make:
        makers = self._makers
        lists = [name for name, each in cls._tx_attrs.items() if each.mult in _LISTS]
        others = {
            name: False if each.bool_assignment else None
            for name, each in cls._tx_attrs.items()
            if each.mult not in _LISTS
        }
        named = {name for name, each in cls._tx_attrs.items() if each.ref and not each.cont}
        if not all(f"{cls.__name__}.{name}" in SCOPE_PROVIDERS for name in named):
            raise TypeError(f"no scope for the references of {cls.__name__}")

        def make(node: Any, parent: Any, references: list[_Named]) -> Any:
            element = cls.__new__(cls)
            attributes = element.__dict__
            attributes.update(others)
            for name in lists:
                attributes[name] = []
            attributes["_tx_position"] = node.position
            if parent is not None:
                attributes["parent"] = parent
            for part in node:
                rule = part.rule
                name = getattr(rule, "_attr_name", None)
                if name is None:
                    continue  # a keyword or a sign
                if rule.rule_name.endswith("_optional"):
                    attributes[name] = True
                    continue
                for each in part:
                    if each.rule_name == _SEPARATOR:
                        continue
                    value = makers[id(each.rule)](each, element, references)
                    if name in named:
                        references.append(_Named(element, name, value))
                    elif name in others:
                        attributes[name] = value
                    else:
                        attributes[name].append(value)
            node.end = attributes["_tx_position_end"] = _end_of(node)
            return element

        return make


def _end_of(node: Any) -> int:
    """Return where a node ends; that of an element in it is known, so long chains are short."""
    last = node
    while isinstance(last, NonTerminal):
        known: int | None = last.end
        if known is not None:
            return known
        last = last[-1]
    end: int = last.position_end
    return end


def _text(node: Any, parent: Any, references: list[_Named]) -> Any:
    """Return the text of a node; that of one token knows its place."""
    if not isinstance(node, NonTerminal):
        return node.value
    if len(node) == 1:
        return _text(node[0], parent, references)
    return "".join(str(_text(each, parent, references)) for each in node)
