"""The rules of a system: loaded ones, those in its folder, and nodes not generated yet."""

from __future__ import annotations

import re
from collections.abc import Container, Iterable, Iterator, Mapping, Sequence
from fnmatch import fnmatchcase
from glob import has_magic
from pathlib import Path, PurePath

from deros import codes
from deros.diagnostics import Diagnostic, Related, SourceFile, report
from deros.metamodels.load import LoadedFile, Repository
from deros.models.node import NodeType
from deros.models.rules import Rules
from deros.models.system import NodeInstance, SafetyInstance, Subsystem, System
from deros.systems.flatten import nodes_of_rules
from deros.systems.safety_nodes import CPP_SUFFIX, is_safety_node

_USE = re.compile(r'\buse\s*"([^"\n]*)"')
_MOST_CHARACTERS = 1 << 20
_FOLLOW = frozenset(
    {
        codes.INCOMPATIBLE_QOS,
        codes.PINNED_QOS_VIOLATED,
        codes.PINNED_TYPE_VIOLATED,
        codes.TYPE_MISMATCH,
        codes.UNCERTAIN_QOS,
        codes.UNWIRED_PORT,
    }
)
"""Codes of findings that an outdated description causes in a correct system."""


def contained_systems(part: System | Subsystem) -> Iterator[System]:
    """Yield the systems that a system uses as subsystems, and those that they use in turn."""
    for member in part.members:
        if isinstance(member, Subsystem):
            yield from contained_systems(member)
            if member.system is not None and member.system is not part:
                yield member.system
                yield from contained_systems(member.system)


def neighbours(loaded: Sequence[LoadedFile], repository: Repository) -> list[LoadedFile]:
    """Load the rules beside a system with safety nodes whose rules are not loaded yet.

    A safety node that is wired by hand does not say which file its rules are in. Rules in the same
    folder that use the system are those that it is to be checked against.
    """
    models = [each.model for each in loaded]
    used = {id(use.system) for model in models if isinstance(model, Rules) for use in model.uses}
    found: dict[int, LoadedFile] = {}
    for model in models:
        if not isinstance(model, System) or id(model) in used or not has_safety_node(model):
            continue
        path = Path(model.source.path)
        for candidate in repository.listing(path.parent, "*.deros"):
            if _mentions(candidate, path.name):
                rules = repository.load(candidate)
                if isinstance(rules.model, Rules) and any(
                    use.system is model for use in rules.model.uses
                ):
                    found[id(rules)] = rules
    known = {id(each) for each in loaded}
    return [each for key, each in found.items() if key not in known]


def _are_stated(rules: Rules) -> bool:
    """Return whether a used system runs the rules by a ``safety`` statement.

    No description of their nodes is needed then.
    """
    systems = [use.system for use in rules.uses if use.system is not None]
    return any(
        each.reference.rules is rules
        for system in systems
        for part in (system, *contained_systems(system))
        for each in _statements(part)
    )


def _statements(part: System | Subsystem) -> Iterator[SafetyInstance]:
    yield from part.safety
    for member in part.members:
        if isinstance(member, Subsystem):
            yield from _statements(member)


def has_safety_node(system: System) -> bool:
    """Return whether a system's own file has, or may have, a safety node that is wired by hand."""
    return any(node.type is None or is_safety_node(node.type) for node in _instances(system))


def _instances(part: System | Subsystem) -> Iterator[NodeInstance]:
    for member in part.members:
        if isinstance(member, NodeInstance):
            yield member
        else:
            yield from _instances(member)


def _mentions(path: Path, system: str) -> bool:
    """Return whether a file's text has a ``use`` of a file of that name."""
    try:
        with path.open(encoding="utf-8", errors="replace") as file:
            text = file.read(_MOST_CHARACTERS)
    except OSError:
        return False
    return any(PurePath(used).name == system for used in _USE.findall(text))


def adapt_to_generated(
    findings: Iterable[Diagnostic], watching: Mapping[int, Sequence[Rules]]
) -> Iterator[Diagnostic]:
    """Adapt findings about descriptions that are generated from the rules.

    A missing description is reported as one that has not been generated yet. Of an outdated one,
    ports that it lacks and types that it has wrong only follow from that.
    """
    programs = {id(rules): rules for each in watching.values() for rules in each}
    names = {
        f"{node.name}{suffix}": (rules, node)
        for rules in programs.values()
        if not _are_stated(rules)
        for node in nodes_of_rules(rules)
        for suffix in ("", CPP_SUFFIX)
    }
    found = list(findings)
    outdated = {
        place.span.source
        for finding in found
        if finding.code is codes.SAFETY_DESCRIPTION_DIFFERS
        for place in finding.related[:1]
    }
    for finding in found:
        text = finding.span.text.strip('"')
        if finding.code in (codes.UNKNOWN_IMPORT, codes.UNKNOWN_NODE_TYPE):
            pattern = PurePath(text).name if finding.code is codes.UNKNOWN_IMPORT else f"{text}.rnd"
            name = next((each for each in names if fnmatchcase(f"{each}.rnd", pattern)), None)
            is_elsewhere = has_magic(text) and finding.hint  # the hint is a folder that exists
            if name is not None and not is_elsewhere:
                yield _not_generated(finding, name, names[name][0])
                continue
        if not _only_follows(finding, names, outdated):
            yield finding


def _not_generated(finding: Diagnostic, name: str, rules: Rules) -> Diagnostic:
    path = rules.source.path
    target = "cpp" if name.endswith(CPP_SUFFIX) else "python"
    return report(
        codes.SAFETY_NOT_GENERATED,
        f"'{name}' has not been generated from the rules '{rules.name}' yet",
        finding.span,
        f"'deros generate {path} --target {target}' makes {name}.rnd; a"
        f" statement 'safety \"{PurePath(path).name}\"' needs no description",
        (Related(rules.uses[0].span, "the rules use the system"),) if rules.uses else (),
    )


def _only_follows(
    finding: Diagnostic,
    names: Mapping[str, tuple[Rules, NodeType]],
    outdated: Container[SourceFile],
) -> bool:
    """Return whether a finding goes away when outdated descriptions are generated again."""
    if finding.code is codes.UNKNOWN_PORT:
        return _is_to_come(finding, names)
    return finding.code in _FOLLOW and any(r.span.source in outdated for r in finding.related)


def _is_to_come(finding: Diagnostic, names: Mapping[str, tuple[Rules, NodeType]]) -> bool:
    """Return whether a port is unknown only until the node is generated again."""
    for related in finding.related:
        found = names.get(related.span.text)
        if found is not None:
            return found[1].port(finding.span.text) is not None
    return False
