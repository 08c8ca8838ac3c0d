"""What an import says of a thing for which its user has a statement of their own."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import MISSING, Field, fields, replace
from typing import Any

from deros.diagnostics import Span
from deros.importers.kept.statements import Statement
from deros.models.common import QosProfile
from deros.models.node import Port
from deros.models.qos import SYSTEM_DEFAULT, pinned_policies, policies
from deros.models.system import NodeInstance, Subsystem, Topic, Wiring
from deros.names.graph_names import resolve_name

_COMPARED_ELSEWHERE = frozenset(
    {"name", "topics", "members", "safety", "processes", "made", "settings"}
)
"""Fields by which statements are matched, and those with statements of their own."""

_SAME_RATE = 1.2
"""The factor within which two measured rates count as one."""


def otherwise(own: Statement, imported: Statement) -> Iterator[str]:
    """Yield what the import says, as text, and the user's statement lacks or says otherwise.

    What the user says besides is theirs. Where the import says nothing of an aspect, so that it
    has its usual value, the user may choose another one.
    """
    if type(own.part) is not type(imported.part):
        yield one_line(imported.span)
        return
    begins = False
    for aspect in fields(imported.part):
        said = getattr(imported.part, aspect.name)
        if not _is_compared(aspect, said, imported.part):
            continue
        mine = getattr(own.part, aspect.name)
        if aspect.name == "namespace" and isinstance(own.part, NodeInstance | Subsystem):
            begins |= own.namespace != imported.namespace
        elif isinstance(said, tuple) and all(hasattr(each, "span") for each in said):
            known = [_plain(each, own) for each in mine]
            yield from (one_line(each.span) for each in said if _plain(each, imported) not in known)
        elif isinstance(said, QosProfile):
            begins |= _is_other_qos(mine, said, own.part)
        elif aspect.name == "rate_hz":
            begins |= mine is None or not said / _SAME_RATE <= mine <= said * _SAME_RATE
        else:
            begins |= mine != said
    if begins:
        yield one_line(imported.span)


def _is_compared(aspect: Field[Any], said: object, part: object) -> bool:
    if not aspect.compare or aspect.name in _COMPARED_ELSEWHERE:
        # A file and a topic that is declared are known by their names alone.
        return False
    if isinstance(part, Topic) and aspect.name == "external":
        return True  # a topic without the word says as much as one with it
    usual = aspect.default_factory() if aspect.default_factory is not MISSING else aspect.default
    return said is not None and (usual is MISSING or said != usual)


def _plain(part: Any, of: Statement) -> Any:
    """Return a part of a statement in the form that means the same everywhere."""
    if not isinstance(part, Wiring) or part.target_from is not None:
        return part
    target = resolve_name(part.target, of.namespace, of.part.name)
    return replace(part, port=part.port.removeprefix("/"), target=target)


def _is_other_qos(own: QosProfile | None, imported: QosProfile, part: Port | Topic) -> bool:
    """Return whether a policy that the import states is another one, or not stated, here."""
    wanted = pinned_policies(imported)
    if isinstance(part, Topic):
        stated = {} if own is None else pinned_policies(own)
        return any(stated.get(policy) != value for policy, value in wanted.items())
    if imported.preset == SYSTEM_DEFAULT:
        return policies(own) != policies(imported)
    return any(getattr(policies(own), policy) != value for policy, value in wanted.items())


def one_line(span: Span) -> str:
    """Return the first line of a statement, without the brace that opens what is in it."""
    first, more, _ = span.text.partition("\n")
    if more:
        first = first.partition("//")[0]
    return " ".join(first.split()).removesuffix("{").rstrip()
