"""Checks of the parameter files that a system names: whether they are there, and who reads what.

Whether the values fit the parameters is checked with those that the system sets itself
(:mod:`deros.validators.system.system_nodes`). What no node reads is only known of a system that
stands on its own: the names of a used one begin where it is used.
"""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterable, Iterator

from deros import codes
from deros.diagnostics import Diagnostic, Related, report
from deros.models.parameter_files import (
    MARK,
    Document,
    FileValue,
    ParameterFile,
    Section,
    Substituted,
    Unmovable,
)
from deros.models.qos import OVERRIDES
from deros.names.names import did_you_mean, near
from deros.systems.flat import FlatNode, FlatSystem
from deros.systems.groups import has_parameter
from deros.systems.parameters.overrides import documents, matches
from deros.validators.findings.hints import one_of
from deros.validators.findings.named_files import Kind, unusable
from deros.validators.system.running.launch_files import unknown_nodes

_FILE = Kind(
    codes.NO_PARAMETER_FILE,
    codes.UNCHECKED_PARAMETER_FILE,
    codes.BAD_PARAMETER_FILE,
    "the system reads it here",
)


def check_parameter_files(flat: FlatSystem, *, is_whole: bool) -> Iterator[Diagnostic]:
    """Yield the findings about the parameter files of a system."""
    for statement in flat.files:
        yield from _unreadable(statement)
    if not flat.files:
        return
    # A node that is not described may read any section.
    unknown = [each for launch in unknown_nodes(flat) for each in launch.files]
    open_ended = {document.contents for _, document in documents(unknown)}
    read = [document for _, document in documents(flat.files)]
    for document in {(each.path, each.substituted is None): each for each in read}.values():
        yield from _unusable_values(document)
    for document in {each.contents: each for each in read}.values():
        if is_whole and document.contents not in open_ended:
            yield from _unread(document, flat)
    for node in flat.nodes:
        yield from _beaten(node)


def _unreadable(statement: ParameterFile) -> Iterator[Diagnostic]:
    """Yield why the file of a statement cannot be used, or not with its keys moved."""
    below = statement.below
    if below is not None and below.fault is not None and not below.is_assumed:
        yield report(
            codes.UNFIT_BELOW,
            f"no key of a file can stand below '{below.namespace}': it {below.fault}",
            below.span,
            "write a namespace such as 'front' or '/arm/left', or \"\" to leave the keys in place",
        )
    found = statement.load()
    if isinstance(found, Unmovable):
        place = Related(statement.path_span if below is None else below.span, "it is moved here")
        yield report(codes.UNMOVABLE_KEY, found.message, found.span, found.hint, (place,))
    else:
        yield from unusable(statement.path, statement.path_span, found, _FILE)
    if isinstance(found, Document) and found.substituted is not None:
        yield from _substitution(statement, found.substituted)


def _substitution(statement: ParameterFile, made: Substituted) -> Iterator[Diagnostic]:
    """Yield what cannot be substituted in a file, and what is given in vain."""
    place = Related(statement.path_span, "the system reads it here")
    for fault in made.faults:
        yield report(codes.SUBSTITUTION_IN_FILE, fault.message, fault.span, fault.hint, (place,))
    for each in statement.given or ():
        if each.name not in made.used:
            message = f"nothing in '{statement.path}' uses '{each.name}'"
            hint = did_you_mean(near(each.name, dict.fromkeys(made.used)), each.name)
            hint = hint or f"remove it, or write '$(var {each.name})' in the file"
            yield report(codes.SUBSTITUTION_IN_FILE, message, each.name_span, hint)


# Values -------------------------------------------------------------------------------------------


def _unusable_values(document: Document) -> Iterator[Diagnostic]:
    for section in document.sections:
        for value in section.values:
            yield from _unusable(value, is_substituted=document.substituted is not None)


def _unusable(found: FileValue, *, is_substituted: bool) -> Iterator[Diagnostic]:
    if found.value is None:
        yield report(
            codes.BAD_PARAMETER_FILE,
            f"'{found.name}' has no value that ROS 2 reads: an empty list or mapping has no type",
            found.value_span,
            "leave it out; a node whose default is not empty needs another parameter for that",
        )
        return
    values = found.value if isinstance(found.value, tuple) else (found.value,)
    for each in values if not is_substituted else ():
        if isinstance(each, str) and "$(" in each:
            yield report(
                codes.SUBSTITUTION_IN_FILE,
                f"'{each}' is not substituted: a node reads the file as it is",
                found.value_span,
                "give the values behind the path of the file, '(NAME = $argument)', or '()' for"
                " what is looked up",
            )
            return


# What nobody reads --------------------------------------------------------------------------------


def _unread(document: Document, flat: FlatSystem) -> Iterator[Diagnostic]:
    readers = [node for node in flat.nodes if _reads(node, document)]
    named = (file for node in readers for file, each in documents(node.files) if each is document)
    is_shared = all(file.in_package is not None for file in named)
    for section in document.sections:
        meant = [node for node in readers if matches(section.key, node.full_name)]
        if not meant and not (is_shared and _is_for_others(section, readers)):
            yield from _no_reader(section, document.keys, readers, flat.nodes)
        elif "*" in section.key and meant:
            whom = "reads this file" if MARK in document.keys else f"'{section.key}' is for"
            yield from _unknown_to_all(section, meant, whom)


def _reads(node: FlatNode, document: Document) -> bool:
    return any(each.path == document.path for _, each in documents(node.files))


def _is_for_others(section: Section, readers: Iterable[FlatNode]) -> bool:
    """Return whether a section of a package's file is for a node that this system does not have.

    A package writes one file for all who use it, and for the nodes that a program makes inside its
    own process. A key that is spelled like a node that reads the file is meant for that.
    """
    return not _alike_names(section.key, [node.full_name for node in readers])


def _no_reader(
    section: Section,
    keys: tuple[str, ...],
    readers: Iterable[FlatNode],
    nodes: Iterable[FlatNode],
) -> Iterator[Diagnostic]:
    """Yield that no node reads a section, for each place of its key.

    Where it has been moved below a namespace, only what is there can be meant.
    """
    others = [node for node in nodes if matches(section.key, node.full_name)]
    message = f"no node of the system is called '{section.key}': these parameters set nothing"
    names = dict.fromkeys(node.full_name for node in (*readers, *nodes))
    below = "".join(keys[:1]).strip("/")
    start = f"/{below}/" if below else ""
    if keys:
        names = {each.removeprefix(start or "/"): None for each in names if each.startswith(start)}
    hint = _meant(section.key.removeprefix(start[1:]).removeprefix(start), list(names))
    related: tuple[Related, ...] = ()
    if others:
        named = others[0].instance
        message = f"'{others[0].full_name}' does not read this file: these parameters set nothing"
        hint = f"write 'parameters from' at '{named.name}', or around it"
        related = (Related(named.name_span, "the node"),)
    for span in section.spans:
        yield report(codes.UNREAD_SECTION, message, span, hint, related)


def _meant(key: str, names: list[str]) -> str:
    """Return which full names a key may mean, for a hint: no edit, keys around it may be part."""
    return str(did_you_mean(_alike_names(key, names))) or one_of(names, "its nodes")


def _alike_names(key: str, names: list[str]) -> list[str]:
    """Return the full names that are spelled like a key, or end alike."""
    absolute = key if key.startswith("/") else f"/{key}"
    last = absolute.rpartition("/")[2]
    by_last: dict[str, list[str]] = defaultdict(list)
    for name in names:
        by_last[name.rpartition("/")[2]].append(name)
    alike = by_last.get(last) or near(absolute, names)
    return list(alike or [name for each in near(last, by_last) for name in by_last[each]])


def _unknown_to_all(section: Section, meant: list[FlatNode], whom: str) -> Iterator[Diagnostic]:
    """Yield the parameters under a key for several nodes that none of these has."""
    for value in section.values:
        if any(_knows(node, value.name) for node in meant):
            continue
        known = [p.name for node in meant if node.type for p in node.type.parameters]
        yield report(
            codes.UNREAD_PARAMETER,
            f"no node that {whom} has a parameter '{value.name}'",
            value.name_span,
            did_you_mean(near(value.name, dict.fromkeys(known)), value.name)
            or "remove it, or declare it",
        )


def _knows(node: FlatNode, name: str) -> bool:
    if node.type is None or node.type.takes_any_parameter:
        return True
    return has_parameter(node.type, name) or name.startswith(OVERRIDES)


def _beaten(node: FlatNode) -> Iterator[Diagnostic]:
    for setting, value in node.beaten:
        yield report(
            codes.BEATEN_BY_FILE,
            f"'{node.full_name}' does not get this value of '{setting.name}': a parameter file"
            " overrides it",
            setting.value_span,
            "remove it there, or write it in the file",
            (Related(value.value_span, "this value wins"),),
        )
