"""The finding for an interface type that cannot be found: its package or its name is unknown."""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator

from deros import codes
from deros.diagnostics import Diagnostic, NearMiss, Span, report
from deros.interfaces.store import InterfaceStore
from deros.interfaces.types import InterfaceKind, InterfaceType
from deros.names.names import did_you_mean, near

_WORD: dict[InterfaceKind, str] = {"msg": "message", "srv": "service", "action": "action"}
_A: dict[InterfaceKind, str] = {"msg": "a message", "srv": "a service", "action": "an action"}


def type_finding(store: InterfaceStore, wanted: InterfaceType, span: Span) -> Iterator[Diagnostic]:
    """Yield one finding if ``store`` has no usable ``wanted``, with the names that nearly match."""
    if store.exists(wanted):
        problem = store.problem(wanted)
        if problem is not None:
            yield report(codes.UNUSABLE_DEFINITION, problem.about(wanted), span)
        return
    if not store.has_package(wanted.package):
        yield _unknown_package(store, wanted.package, span)
        return
    word = _WORD[wanted.kind]
    yield report(
        codes.UNKNOWN_TYPE,
        f"package '{wanted.package}' has no {word} type '{wanted.name}'",
        span,
        hint=did_you_mean(near(wanted.name, store.names(wanted.package, wanted.kind)), wanted.name)
        or _elsewhere(store, wanted),
    )


_OF_OTHERS = (
    "for your own interfaces, pass their folder with --interfaces PATH or source their workspace"
)


def _unknown_package(store: InterfaceStore, package: str, span: Span) -> Diagnostic:
    """Return the finding for an unknown package.

    One whose name is that of an interface package may well exist: where to find it comes first.
    """
    meant = near(package, _like(package, store.packages()))
    message = f"unknown interface package '{package}'"
    nearly = did_you_mean(meant, package)
    if _stem(package) != package and nearly:
        nearly = NearMiss(f"{_OF_OTHERS}; {nearly}", meant, package)
    return report(codes.UNKNOWN_PACKAGE, message, span, nearly or _OF_OTHERS)


def _like(package: str, known: Iterable[str]) -> list[str]:
    """Leave out packages that resemble ``package`` in nothing but an ending such as ``_msgs``."""
    stem = _stem(package)
    return [each for each in known if _stem(each) == stem or near(stem, [_stem(each)])]


def _stem(package: str) -> str:
    return re.sub(r"_(msgs|srvs|interfaces)$", "", package)


def _elsewhere(store: InterfaceStore, wanted: InterfaceType) -> str:
    """Return a hint at a type of this name of another kind, or in another package."""
    for kind in _WORD:
        if kind != wanted.kind and wanted.name in store.names(wanted.package, kind):
            return f"'{wanted.short}' is {_A[kind]} type, not {_A[wanted.kind]} type"
    owners = sorted(p for p in store.packages() if wanted.name in store.names(p, wanted.kind))
    return f"there is {' and '.join(f'{p}.{wanted.name}' for p in owners[:3])}" if owners else ""
