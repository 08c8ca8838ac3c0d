"""The tables of behaviours, actions and sites that reports refer to."""

from __future__ import annotations

from collections.abc import Iterator

from deros.generators.monitor.c.interface import MonitorView, Site
from deros.generators.safety_node.view import (
    behaviour_views,
    lasts,
    needs_code,
    only_resets,
    origin_file,
    refusing_behaviours,
)
from deros.generators.text.cpp import Expression, Table, Text, cpp_string, expression
from deros.models.rules import Rules
from deros.rules.compiler.actions import LOG_STATE
from deros.rules.program import walk
from deros.rules.program.ir import Action, Program

NONE = "std::nullopt"

Item = str | Text | list["Item"]
"""An expression, or an initialiser list of several."""


def rule_metadata_view(
    model: Rules, program: Program, monitor: MonitorView, actions_file: str
) -> list[Item]:
    """Return the initialiser of the table of rule metadata."""
    return [
        cpp_string(origin_file(model)),
        str(len(program.rules)),
        cpp_string(actions_file),
        [*_behaviours(program)],
        [*_actions(program, monitor)],
        [*_sites(program, monitor)],
        [*_inputs(program, monitor)],
    ]


def table(item: Item, indent: int) -> str:
    """Return an initialiser as text for a template that has written ``indent`` blanks already."""
    return expression(_initializer(item), indent, ",").removesuffix(",")


def _initializer(item: Item) -> Expression:
    return Table(tuple(map(_initializer, item))) if isinstance(item, list) else item


def _behaviours(program: Program) -> Iterator[list[Item]]:
    optional = {each.name: each.optional for each in walk.behaviours(program)}
    for each in behaviour_views(program):
        yield [
            cpp_string(each.name),
            cpp_string(each.origin),
            Text(each.condition),
            [*map(cpp_string, each.rules)],
            _truth(optional[each.name]),
        ]


def _actions(program: Program, monitor: MonitorView) -> Iterator[list[Item]]:
    latched = [action.index for action in program.actions if action.latched]
    first: dict[int, int] = {}
    for number, site in enumerate(monitor.sites.rows):
        if site.behaviour is not None:
            first.setdefault(site.action, number)
    for action in program.actions:
        yield [
            cpp_string(action.name),
            *_kind(action, program),
            str(latched.index(action.index)) if action.latched else NONE,
            str(first[action.index]) if action.index in first else NONE,
            [*(str(each) for each in refusing_behaviours(action))],
        ]


def _kind(action: Action, program: Program) -> Iterator[str]:
    yield _truth(action.binding is not None)
    yield _truth(needs_code(action))
    yield _truth(lasts(action))
    yield _truth(action.name != LOG_STATE)
    yield _truth(only_resets(action, program))


def _sites(program: Program, monitor: MonitorView) -> Iterator[list[Item]]:
    for site in monitor.sites.rows:
        yield _site(program, site)
    yield [NONE, NONE, '""', '""', "0"]


def _site(program: Program, site: Site) -> list[Item]:
    says = program.actions[site.action].name == LOG_STATE and site.arguments
    return [
        str(site.action),
        NONE if site.behaviour is None else str(site.behaviour),
        cpp_string(", ".join(map(repr, site.arguments))),
        cpp_string(str(site.arguments[0])) if says else '""',
        str(site.line),
    ]


def _inputs(program: Program, monitor: MonitorView) -> Iterator[list[Item]]:
    topics = [each.handler.topic for each in monitor.messages]
    for each in program.inputs:
        yield [cpp_string(each.name), str(topics.index(each.topic))]


def _truth(value: bool) -> str:
    return "true" if value else "false"
