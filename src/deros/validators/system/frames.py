"""Checks of the frames of a system: each has one parent, which one node broadcasts."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

from deros import codes
from deros.diagnostics import Diagnostic, Related, report
from deros.models.common import Value
from deros.models.node import Frame
from deros.systems.flat import FlatNode, FlatSystem


@dataclass(frozen=True, slots=True)
class _Broadcast:
    """A transform that a node broadcasts, with the names that its frames have at run time.

    ``tree``: the topic of the transforms, without the ``_static`` of those that do not change.
    """

    node: FlatNode
    frame: Frame
    tree: str
    parent: str
    child: str

    @property
    def transform(self) -> str:
        return f"'{self.parent} -> {self.child}'"


def check_broadcasts(flat: FlatSystem) -> Iterator[Diagnostic]:
    """Yield the finding that a frame is broadcast twice: listeners see it jump between the two."""
    first: dict[tuple[str, str], _Broadcast] = {}
    for node in flat.nodes:
        for broadcast in _broadcasts(node):
            other = first.setdefault((broadcast.tree, broadcast.child), broadcast)
            if other is not broadcast:
                yield _twice(other, broadcast)


def _broadcasts(node: FlatNode) -> Iterator[_Broadcast]:
    """Yield what a node broadcasts as it is set; a name or switch without a value is left out."""
    if node.type is None:
        return
    values: dict[str, Value | None] = {each.name: each.default for each in node.type.parameters}
    values |= dict(node.parameters)
    for end in node.ports:
        for frame in end.port.frames:
            parent, child = frame.parent.filled_in(values), frame.child.filled_in(values)
            is_on = frame.switch is None or values.get(frame.switch.text) is True
            if is_on and parent and child:
                tree = end.topic.removesuffix("_static")
                yield _Broadcast(node, frame, tree, parent, child)


def _twice(first: _Broadcast, second: _Broadcast) -> Diagnostic:
    one, other = f"'{first.node.full_name}'", f"'{second.node.full_name}'"
    if first.node is second.node:
        fault = f"{one} broadcasts frame '{first.child}' twice, as {first.transform} and as"
        fault += f" {second.transform}"
    elif first.parent == second.parent:
        fault = f"{one} and {other} both broadcast {first.transform}"
    else:
        fault = f"{one} broadcasts {first.transform}, and {other} {second.transform}"
    return report(
        codes.FRAME_BROADCAST_TWICE,
        f"{fault}: a frame has one parent, from one node",
        second.node.instance.name_span,
        _remedy(first, second),
        (Related(first.node.instance.name_span, "the first node that broadcasts it"),),
    )


def _remedy(first: _Broadcast, second: _Broadcast) -> str:
    """Return how to switch one of the two off, or else how to give one another name."""
    switches = [
        f"'param {each.frame.switch.text} = false' for '{each.node.instance.name}'"
        for each in (first, second)
        if each.frame.switch is not None
    ]
    if switches:
        return f"set {' or '.join(dict.fromkeys(switches))}"
    names = [
        f"'{parameter}' of '{each.node.instance.name}'"
        for each in (first, second)
        for parameter in each.frame.child.parameters
    ]
    if names:
        return f"give one of the frames another name: set {' or '.join(dict.fromkeys(names))}"
    is_one = first.node is second.node
    return f"keep one of the two {'lines of its description' if is_one else 'nodes'}"
