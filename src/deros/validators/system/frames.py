"""Checks of the frames of a system: each has one parent, which one node broadcasts.

A monitor of transforms watches one that some node broadcasts again and again.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

from deros import codes
from deros.diagnostics import Diagnostic, Related, report
from deros.models.common import Value
from deros.models.node import TRANSFORMS, Frame, PortKind
from deros.systems.flat import FlatNode, FlatSystem
from deros.systems.running.monitors import (
    CHILD,
    PARENT,
    is_transform_monitor,
    place_of,
    watched_transform,
)
from deros.validators.findings.hints import did_you_mean, one_of

_STATIC = "_static"
"""What the topic has behind its name of transforms that are broadcast once, and never change."""


@dataclass(frozen=True, slots=True)
class _Broadcast:
    """A transform that a node broadcasts, with the names that its frames have at run time.

    ``tree``: the topic of the transforms, without the ``_static`` of those that do not change, as
    ``is_static`` says.
    """

    node: FlatNode
    frame: Frame
    tree: str
    parent: str
    child: str
    is_static: bool

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
                tree, is_static = end.topic.removesuffix(_STATIC), end.topic.endswith(_STATIC)
                yield _Broadcast(node, frame, tree, parent, child, is_static)


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


def check_transform_monitors(flat: FlatSystem) -> Iterator[Diagnostic]:
    """Yield the findings about transforms that are watched, and that no node broadcasts.

    Where a node of which nobody says what it broadcasts may do it, there is none.
    """
    monitors = [node for node in flat.nodes if is_transform_monitor(node)]
    if not monitors:
        return
    known = [each for node in flat.nodes for each in _broadcasts(node)]
    silent = {tree for node in flat.nodes for tree in _undescribed(node)}
    silent |= {each.name for each in flat.topics if each.declaration.external}
    for monitor in monitors:
        wanted = watched_transform(monitor)
        for heard in _heard(monitor):
            if not all(wanted) or heard in silent:
                continue  # what has no value is reported
            there = [each for each in known if each.tree == heard]
            meant = [each for each in there if (each.parent, each.child) == wanted]
            if all(each.is_static for each in meant):
                yield _unheard(monitor, heard, wanted, there, meant)


def _heard(monitor: FlatNode) -> Iterator[str]:
    """Yield the topics on which a monitor hears transforms: one, if it is described as it is."""
    for end in monitor.ports:
        if end.port.kind is PortKind.SUBSCRIPTION and end.port.type.short == TRANSFORMS:
            yield end.topic


def _undescribed(node: FlatNode) -> Iterator[str]:
    """Yield the topics on which a node broadcasts transforms that its description does not name."""
    for end in node.ports:
        described = end.port.frames or end.port.kind is not PortKind.PUBLISHER
        if not described and end.port.type.short == TRANSFORMS:
            yield end.topic


def _unheard(
    monitor: FlatNode,
    heard: str,
    wanted: tuple[str, str],
    there: list[_Broadcast],
    static: list[_Broadcast],
) -> Diagnostic:
    """Return the finding about a transform that a monitor never hears of, or once only."""
    name, shown = monitor.instance.name, f"'{wanted[0]} -> {wanted[1]}'"
    if static:
        first = static[0].node
        return report(
            codes.TRANSFORM_OF_NOBODY,
            f"'{first.full_name}' broadcasts {shown} once, as one that never changes:"
            f" it has no age that '{name}' could show",
            place_of(monitor, CHILD),
            "watch one that is broadcast again and again",
            (Related(first.instance.name_span, f"'{first.instance.name}'"),),
        )
    moving = [each for each in there if not each.is_static]
    fault = f"no node of the system broadcasts {shown}, which '{name}' is to watch"
    parent, child = wanted
    for end, written, meant in (
        (CHILD, child, [each.child for each in moving if each.parent == parent]),
        (PARENT, parent, [each.parent for each in moving if each.child == child]),
    ):
        if hint := did_you_mean(written, meant):
            return report(codes.TRANSFORM_OF_NOBODY, fault, place_of(monitor, end), hint)
    return report(
        codes.TRANSFORM_OF_NOBODY,
        fault,
        place_of(monitor, CHILD),
        one_of((f"{each.parent} -> {each.child}" for each in moving), "there are")
        or "describe what is broadcast, at the publisher: '{ frame PARENT -> CHILD }'; if that is"
        f" outside the model, declare 'external topic {heard}'",
    )
