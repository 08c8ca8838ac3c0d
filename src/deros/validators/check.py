"""All checks of a run: every file that the user named, and everything that those files import."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence
from typing import NamedTuple

from deros.diagnostics import Code, Diagnostic, Span, in_file_order
from deros.interfaces.store import InterfaceStore
from deros.metamodels.languages import entry_point
from deros.metamodels.load import LoadedFile, Repository
from deros.models.node import NodeType
from deros.models.rules import Rules
from deros.models.system import System
from deros.rules.compiler.build_cache import BuildCache
from deros.validators.findings.allowances import apply_allowances
from deros.validators.findings.allowed import Allowed, ProjectAllowance
from deros.validators.findings.consequences import without_consequences
from deros.validators.findings.context import CheckContext
from deros.validators.safety.safety_rules import adapt_to_generated, contained_systems, neighbours

NodeFindings = dict[str, tuple[LoadedFile, tuple[Diagnostic, ...]]]
"""The findings of node descriptions by path; they rest on the file and on messages alone."""


class Checked(NamedTuple):
    """The findings of a run, and those that are allowed."""

    findings: list[Diagnostic]
    allowed: list[Allowed]


def check(
    named: Sequence[LoadedFile],
    repository: Repository,
    store: InterfaceStore,
    project: Sequence[ProjectAllowance] = (),
    builds: BuildCache | None = None,
) -> list[Diagnostic]:
    """Return the findings of :func:`check_all` that are not allowed."""
    return check_all(named, repository, store, project, builds).findings


def check_all(
    named: Sequence[LoadedFile],
    repository: Repository,
    store: InterfaceStore,
    project: Sequence[ProjectAllowance] = (),
    builds: BuildCache | None = None,
    of_nodes: NodeFindings | None = None,
) -> Checked:
    """Return the findings of the files in ``named`` and of their imports, in file order.

    A system that was named, or that rules use, is checked as a whole; one that only another system
    imports is checked as it is written, because the importing system may feed its topics.

    Args:
        named: the files that the user named.
        repository: where they were loaded, with all that they import.
        store: the definitions of messages.
        project: what the project's file allows.
        builds: the rules built so far in this run; those of the checks are added.
        of_nodes: findings of an earlier check with the same definitions; those of this one are
            added.
    """
    builds = builds or BuildCache(store)
    of_nodes = {} if of_nodes is None else of_nodes
    loaded = list({id(each): each for each in (*named, *repository.files)}.values())
    named_files = {id(each) for each in named}
    loaded += neighbours(loaded, repository)
    watching = _watching_rules(loaded)
    findings: list[Diagnostic] = []
    for each in loaded:
        findings.extend(each.diagnostics)
        rules: tuple[Rules, ...] = ()
        rules_of_parts: tuple[Rules, ...] = ()
        if isinstance(each.model, System):
            rules, rules_of_parts = _rules_of(each.model, watching)
        is_whole = id(each) in named_files or bool(rules)
        context = CheckContext(store, builds, is_whole, rules, rules_of_parts)
        if not isinstance(each.model, NodeType):
            findings.extend(_check_model(each, context))
            continue
        if each.path not in of_nodes or of_nodes[each.path][0] is not each:
            of_nodes[each.path] = each, tuple(_check_model(each, context))
        findings.extend(of_nodes[each.path][1])
    found = in_file_order(_without_repeats(adapt_to_generated(findings, watching)))
    sorted_out = apply_allowances(found, loaded, named, project)
    remaining = without_consequences(sorted_out.findings, findings, loaded)
    return Checked(in_file_order(remaining), list(sorted_out.allowed))


def _without_repeats(findings: Iterable[Diagnostic]) -> list[Diagnostic]:
    """Drop findings with the same code, message and position as an earlier one.

    A system that rules use, and that another one contains, is checked on its own and as a part.
    """
    said: dict[tuple[Code, str, Span], Diagnostic] = {}
    for each in findings:
        said.setdefault((each.code, each.message, each.span), each)
    return list(said.values())


def check_file(loaded: LoadedFile, store: InterfaceStore) -> list[Diagnostic]:
    """Return the findings of one file by itself, in file order, without those of its imports."""
    found = _check_model(loaded, CheckContext(store, BuildCache(store)))
    findings = in_file_order([*loaded.diagnostics, *found])
    sorted_out = apply_allowances(findings, [loaded], ())
    return list(without_consequences(sorted_out.findings, findings, [loaded]))


def _rules_of(
    system: System, watching: Mapping[int, list[Rules]]
) -> tuple[tuple[Rules, ...], tuple[Rules, ...]]:
    """Return the rules that use a system, and those that use a system that it contains."""
    whole = watching.get(id(system), [])
    parts: dict[int, Rules] = {}
    if watching:
        for part in contained_systems(system):
            parts |= {id(rules): rules for rules in watching.get(id(part), [])}
    return tuple(whole), tuple(r for r in parts.values() if r not in whole)


def _watching_rules(loaded: Iterable[LoadedFile]) -> dict[int, list[Rules]]:
    """Return the rules that use each system, by the system's identity."""
    watching: dict[int, list[Rules]] = {}
    for each in loaded:
        if isinstance(each.model, Rules):
            for use in each.model.uses:
                if use.system is not None:
                    watching.setdefault(id(use.system), []).append(each.model)
    return watching


def _check_model(loaded: LoadedFile, context: CheckContext) -> Iterator[Diagnostic]:
    """Run the checks of the file's language, which are imported at the first use."""
    if loaded.model is not None and loaded.language is not None:
        yield from entry_point(loaded.language.checks)(loaded.model, context)
