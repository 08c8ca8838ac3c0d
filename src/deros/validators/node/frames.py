"""Checks of the frames that a node broadcasts: the port, and the parameters they depend on."""

from __future__ import annotations

from collections.abc import Iterator

from deros import codes
from deros.diagnostics import Diagnostic, Related, Span, report
from deros.models.node import TRANSFORMS, Frame, NodeType, ParameterType, Port, PortKind
from deros.validators.findings.hints import did_you_mean


def check_frames(node: NodeType, port: Port) -> Iterator[Diagnostic]:
    """Yield the findings about the frames of one port."""
    if not port.frames:
        return
    if port.kind is not PortKind.PUBLISHER or port.type.short != TRANSFORMS:
        yield report(
            codes.BAD_FRAME,
            f"{port.kind.word} '{port.name}' of {port.type.short} does not broadcast transforms",
            port.frames[0].parent.span,
            f"describe frames at a publisher of {TRANSFORMS}",
        )
        return
    for frame in port.frames:
        yield from _names(node, frame)
        if frame.switch is not None:
            name, span = frame.switch.text, frame.switch.span
            yield from _parameter(node, name, span, ParameterType.BOOL)


def _names(node: NodeType, frame: Frame) -> Iterator[Diagnostic]:
    for end in (frame.parent, frame.child):
        for parameter in end.parameters:
            yield from _parameter(node, parameter, end.span, ParameterType.STRING)
    if frame.parent == frame.child:
        yield report(
            codes.BAD_FRAME,
            f"frame '{frame.child.text}' is its own parent",
            frame.child.span,
            "name its parent first: 'frame PARENT -> CHILD'",
        )


def _parameter(node: NodeType, name: str, span: Span, kind: ParameterType) -> Iterator[Diagnostic]:
    """Check that a frame depends on a parameter of the node that has one value of a type."""
    parameter = node.parameter(name)
    if parameter is None:
        alike = [each.name for each in node.parameters if each.type is kind]
        yield report(
            codes.BAD_FRAME,
            f"the frame depends on parameter '{name}', which is not declared",
            span,
            did_you_mean(name, alike, f"declare it: 'name {name or 'frame_id'} : {kind.value}'"),
        )
    elif parameter.type is not kind or parameter.keys:
        use = (
            "switch a frame on or off"
            if kind is ParameterType.BOOL
            else "be part of a frame's name"
        )
        has = (
            "has a value for each entry of a list"
            if parameter.keys
            else f"is {parameter.type.value}"
        )
        yield report(
            codes.BAD_FRAME,
            f"parameter '{name}' {has} and cannot {use}",
            span,
            f"use a {kind.value} parameter",
            (Related(parameter.span, "declared here"),),
        )
