"""Slips planted in a C monitor, by the changes that the mutator for the proof makes, and some more.

Those for the proof are all that it enumerates; here a :class:`Slip` says which of them are made,
and may exchange a value for another one, which has no end of choices.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence

from tree_sitter import Node

from tests.support.c_mutants import Change, Source, code_of, walk
from tests.support.slips import Edit, Slip, edited

_VALUES = ("identifier", "number_literal", "true", "false", "null", "call_expression")


def planted(text: str, header: str, slips: Sequence[Slip]) -> str | None:
    """Return a source with slips made together, or ``None`` if one of them has no place in it.

    Args:
        text: the text of ``robot_monitor.c``.
        header: the text of ``robot_monitor.h``, which names fields and enumerators.
        slips: the changes.
    """
    source = Source(text, header)
    edits: list[Edit] = []
    for slip in slips:
        made = list(_edits(source, slip))
        if not made:
            return None
        edits += made
    return edited(source.data, edits).decode()


def _edits(source: Source, slip: Slip) -> Iterator[Edit]:
    for function, top in source.code():
        if not slip.is_in(function):
            continue
        last = None
        for change in _changes(source, top, slip):
            whole = change.node if change.node.is_named else change.node.parent
            assert whole is not None
            if change.node != last and slip.chooses(change.text) and _is_at(source, slip, whole):
                last = change.node
                yield Edit(change.node.start_byte, change.node.end_byte, change.text)


def _changes(source: Source, top: Node, slip: Slip) -> Iterator[Change]:
    match slip.kind:
        case "value":
            nodes = walk(top.child_by_field_name("body") or top)
            yield from (Change("value", each, slip.to) for each in nodes if _is_read(each))
        case "bound":
            for each in walk(top):
                above = each.parent
                if each.type == "identifier" and above and above.type == "binary_expression":
                    yield Change("bound", each, f"({code_of(each)} + 1)")
        case kind:
            yield from source.changes(top, kind)


def _is_at(source: Source, slip: Slip, node: Node) -> bool:
    return slip.is_at(code_of(node), _around(source.data, node))


def _around(data: bytes, node: Node) -> Iterator[tuple[str, str]]:
    """Yield what is before and after a node in each node around it, within its function."""
    above = node.parent
    while above is not None and above.type != "translation_unit":
        before = data[above.start_byte : node.start_byte].decode()
        yield before, data[node.end_byte : above.end_byte].decode()
        above = above.parent


def _is_read(node: Node) -> bool:
    """Tell whether a node is an expression whose value is read."""
    above = node.parent
    if above is None or not (node.type.endswith("_expression") or node.type in _VALUES):
        return False
    if above.type in ("update_expression", "parameter_declaration", "field_expression"):
        return False
    if above.type == "pointer_expression":
        return code_of(above.children[0]) == "*" and node.type == "identifier"
    written = [above.child_by_field_name(each) for each in ("left", "declarator", "function")]
    if above.type == "binary_expression":
        written = []
    return node not in written
