"""Compares the user's files, which are written once, with a model that has changed since.

A generator returns, for each file of the user, what it would be if it were written today, and the
base classes that belong to it. Both are compared with the file as it is. Nothing is imported or
executed.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence
from pathlib import Path

from deros import codes
from deros.diagnostics import Diagnostic, SourceFile, in_file_order, report
from deros.generators.api.protocol import Files, Owner
from deros.generators.user_files.classes import HOOKS, Base, Name, Written
from deros.generators.user_files.manifest import lacking
from deros.generators.user_files.python import python_classes
from deros.interfaces.files import read_regular

_LARGEST = 4 << 20
_HANDLERS = ("on_", "handle_", "execute_", "accept_", "cancel_")
_OFFERED = ("publish_", "call_", "send_", "client_", "timer_")


def review(files: Files, places: Mapping[str, Path]) -> list[Diagnostic]:
    """Return findings about missing and obsolete names in the user's files.

    Args:
        files: what a generator returned.
        places: where the user's files are, by their path in ``files``; only those that exist.
    """
    found: list[Diagnostic] = []
    sources = {path: _read(place) for path, place in places.items()}
    present = {path: source for path, source in sources.items() if source is not None}
    for path, source in present.items():
        if path.endswith("package.xml"):
            found += lacking(files[path].text, source)
    for base, written in python_classes(files, present):
        found += _compare(base, written)
    return in_file_order(found)


def users_files(files: Files, folder: Path, top: str = "") -> dict[str, Path]:
    """Return where files of the user are that exist, by their path in ``files``.

    Args:
        files: what a generator returned.
        folder: where they are.
        top: the folder in their paths that stands for ``folder`` itself.
    """
    places = {
        path: folder / path.removeprefix(f"{top}/" if top else "")
        for path, file in files.items()
        if file.owner is Owner.USER
    }
    return {path: place for path, place in places.items() if place.is_file()}


def _read(place: Path) -> SourceFile | None:
    try:
        return SourceFile(str(place), read_regular(place, _LARGEST).decode("utf-8-sig"))
    except (OSError, ValueError):
        return None


def _compare(base: Base, written: Written) -> Iterator[Diagnostic]:
    own = {each.text for each in written.methods} | written.known
    missing = [name for name in base.required if name not in own] if written.complete else []
    unknown = [
        each
        for each in written.methods
        if each.text not in base.offered
        and each.text not in HOOKS
        and (written.actions or each.text.startswith(_HANDLERS))
        and each.text not in written.known
    ]
    renamed = _pairs(missing, unknown)
    for name in missing:
        message = f"'{written.name.text}' has no {base.kind} '{name}', which the model now asks for"
        old = renamed.get(name)
        hint = f"rename '{old.text}' in line {old.span.line}" if old else f"write '{name}'"
        yield report(codes.MISSING_METHOD, f"{message}: {base.fatal}", written.name.span, hint)
    for each in unknown:
        new = next((name for name, old in renamed.items() if old is each), None)
        message = f"nothing calls '{each.text}': the model has no such {_what(each.text, written)}"
        hint = f"rename it to '{new}'" if new else "remove it, or call it yourself"
        yield report(codes.UNKNOWN_METHOD, message, each.span, hint)
    if written.complete:
        yield from _unknown_uses(base, written, own)


def _unknown_uses(base: Base, written: Written, own: Iterable[str]) -> Iterator[Diagnostic]:
    from deros.names.names import did_you_mean, near

    declared = {*own}
    for each in written.used:
        if each.text.startswith(_OFFERED) and each.text not in base.offered | declared:
            message = f"'{base.name}' has no '{each.text}' any more"
            same = [name for name in base.offered if name.split("_")[0] == each.text.split("_")[0]]
            hint = did_you_mean(near(each.text, same), each.text)
            yield report(codes.UNKNOWN_METHOD, message, each.span, hint)
    for each in written.parameters:
        if base.parameters is not None and each.text not in base.parameters:
            message = f"the node has no parameter '{each.text}' any more"
            yield report(
                codes.UNKNOWN_METHOD,
                message,
                each.span,
                did_you_mean(near(each.text, base.parameters), each.text),
            )


def _pairs(missing: Sequence[str], unknown: Sequence[Name]) -> dict[str, Name]:
    """Match old methods to new ones: by similar names, or as the only candidates."""
    from deros.names.names import near

    pairs: dict[str, Name] = {}
    left = {each.text: each for each in unknown}
    for name in missing:
        kind = name.split("_")[0]
        same = [each for each in left if each.split("_")[0] == kind]
        only = len(same) == 1 and sum(each.split("_")[0] == kind for each in missing) == 1
        found = near(name, same, 1) or (same if only else [])
        if found:
            pairs[name] = left.pop(found[0])
    return pairs


def _what(name: str, written: Written) -> str:
    if written.actions:
        return "action"
    prefix = name.split("_")[0]
    return {"on": "topic or timer", "handle": "service"}.get(prefix, "action")
