"""Parameter files of ``generate_parameter_library``: the parameters of a node, declared."""

from __future__ import annotations

import re
from collections.abc import Iterator
from pathlib import Path
from typing import NamedTuple

from deros.diagnostics import Span
from deros.importers import node_text
from deros.importers.formats import loading
from deros.importers.formats.draft import Draft
from deros.importers.formats.names import UniqueNames
from deros.importers.formats.parameters import declare, is_declaration, is_type
from deros.importers.readers import Request, UnreadableError, source_of
from deros.importers.results import Imported, Missing, Parts
from deros.metamodels.yaml_trees.tree import Mapping, Scalar
from deros.models.parameter_files import MARK

_MAP = "__map_"
_WHY = "This is from a file of parameters: write the right package, program and ports here."


def is_library(path: Path) -> bool:
    """Return whether a file declares parameters as the library does."""
    if path.suffix not in (".yaml", ".yml"):
        return False
    top = loading.top_of(path)
    if top is None or len(top.entries) != 1:
        return False
    waiting = list(top.entries.values())
    while waiting:
        each = waiting.pop()
        if not isinstance(each, Mapping) or MARK in each.entries:
            continue
        stated = each.get("type")
        if isinstance(stated, Scalar) and is_type(stated.text):
            return True
        waiting += each.entries.values()
    return False


def read_library(request: Request) -> Imported:
    """Return a node description for each file."""
    files: dict[str, Parts] = {}
    missing: list[Missing] = []
    names = UniqueNames()
    for path in request.files:
        draft = _draft(path, request.name if len(request.files) == 1 else None, names)
        draft.clean(request.store)
        node = draft.node
        head = node_text.head(node.name, node.package, node.name, _WHY)
        files[f"nodes/{node.name}.rnd"] = draft.parts(head)
        missing += draft.missing
    return Imported(files, tuple(map(str, missing)))


def _draft(path: Path, name: str | None, names: UniqueNames) -> Draft:
    source = source_of(path)
    top = loading.mapping_of(source)
    if len(top.entries) != 1:
        what = f"has {len(top.entries)} keys at its top, and a library of parameters one"
        raise UnreadableError(f"{path}: this file {what}")
    (root, tree), *_ = top.entries.items()
    # Their namespace in C++ is what comes nearest to the name of a node.
    draft = Draft(names.of(name or root), node_text.UNKNOWN_PACKAGE)
    draft.missing += loading.unused_keys(top)
    if not isinstance(tree, Mapping):
        raise loading.unreadable_at(tree.span, f"'{loading.shown(root)}' has no parameters")
    leaves = list(_leaves(draft, tree, ()))
    known = {".".join(leaf.path) for leaf in leaves}
    for leaf in leaves:
        declare(draft, _name(leaf.path, known), leaf.tree, leaf.place)
    return draft


class _Leaf(NamedTuple):
    path: tuple[str, ...]
    tree: Mapping
    place: Span


def _leaves(draft: Draft, tree: Mapping, above: tuple[str, ...]) -> Iterator[_Leaf]:
    for key, value in tree.entries.items():
        path, place = (*above, key), tree.keys[key]
        what = f"'{'.'.join(path)}'"
        if re.search("[<>]", key):
            draft.lack(what, "is left out: a name has no '<' or '>'", place)
        elif is_declaration(value):
            assert isinstance(value, Mapping)
            yield _Leaf(path, value, place)
        elif isinstance(value, Mapping) and any(
            isinstance(each, Mapping) for each in value.entries.values()
        ):
            yield from _leaves(draft, value, path)
        else:
            draft.lack(what, "is left out: it has no type", place)


def _name(path: tuple[str, ...], known: set[str]) -> str:
    """Return the name of a parameter, with ``<x>`` for each map with the entries of list ``x``."""
    parts = []
    for position, part in enumerate(path):
        if part.startswith(_MAP):
            part = f"<{_list(part.removeprefix(_MAP), path[:position], known)}>"
        parts.append(part)
    return ".".join(parts)


def _list(key: str, scope: tuple[str, ...], known: set[str]) -> str:
    """Return the list that a map is for: that of the innermost scope which has one of the name."""
    scopes = (scope[:end] for end in range(len(scope), -1, -1))
    candidates = (".".join((*each, key)) for each in scopes)
    return next((each for each in candidates if each in known), key)
