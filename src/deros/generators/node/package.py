"""The parts of packages of nodes that do not depend on the language."""

from __future__ import annotations

import re
from pathlib import Path
from typing import TYPE_CHECKING

from deros import codes
from deros.diagnostics import Diagnostic, has_errors, report
from deros.generators.api.protocol import Context, GenerationError, OptionError, Options
from deros.models.node import NodeType, PortKind

if TYPE_CHECKING:
    from deros.metamodels.load import LoadedFile

_MAINTAINER = re.compile(r"([^<>]*)<([^<>\s]+@[^<>\s]+)>\s*")


def refuse_legacy(model: NodeType) -> None:
    """Refuse a node that runs an existing program.

    Raises:
        GenerationError: at the node's name.
    """
    if model.executable is None:
        return
    raise GenerationError(
        [
            report(
                codes.UNSUPPORTED_BY_TARGET,
                f"node {model.name!r} runs the existing program {model.executable!r}: "
                "there is no skeleton to generate",
                model.name_span,
                hint="remove the line 'executable' to have the node generated",
            )
        ]
    )


def nodes_beside(model: NodeType, context: Context) -> list[NodeType]:
    """Return the other nodes of the model's package that are described in its folder.

    Nodes with a program of their own need no skeleton.

    Raises:
        GenerationError: if a file that seems to belong to the package has an error; without it, the
            package would lose a node that it had.
    """
    found: list[NodeType] = []
    own = Path(model.source.path)
    for path in context.repository.listing(own.parent, "*.rnd"):
        if path.name == own.name:
            continue
        loaded = context.repository.load(path)
        if _belongs(loaded, model.package):
            findings = context.check(loaded, context.store)
            if has_errors(findings):
                raise GenerationError(findings)
        other = loaded.model
        if (
            isinstance(other, NodeType)
            and other.package == model.package
            and other.name != model.name
            and other.executable is None
        ):
            found.append(other)
    return found


def _belongs(loaded: LoadedFile, package: str) -> bool:
    """Return whether a file seems to describe a node of ``package``."""
    if isinstance(loaded.model, NodeType):
        return loaded.model.package == package
    text = loaded.source.text if loaded.source else ""
    return re.search(rf":\s*{re.escape(package)}\b", text) is not None


def unsupported(model: NodeType) -> list[Diagnostic]:
    """Return a diagnostic for each construct that no client library supports."""
    found = []
    for parameter in model.parameters:
        if parameter.name in ("use_sim_time", "start_type_description_service"):
            message = f"parameter {parameter.name!r} is declared by every ROS 2 node itself"
            hint = "remove it; it can be set all the same"
            span = parameter.name_span
            found.append(report(codes.UNSUPPORTED_BY_TARGET, message, span, hint))
    for port in model.ports:
        action = port.kind in (PortKind.ACTION, PortKind.ACTION_CLIENT)
        if action and port.qos is not None:
            message = f"an action has five services and topics, {port.name!r} gives one QoS profile"
            hint = "leave the QoS of actions to ROS 2"
            found.append(report(codes.UNSUPPORTED_BY_TARGET, message, port.span, hint))
    return found


def maintainer(options: Options) -> tuple[str, str]:
    """Return name and address of the option ``maintainer``.

    Raises:
        OptionError: if it does not read ``Name <address>``.
    """
    text = options.get("maintainer")
    if text is None:
        return "maintainer", "maintainer@example.com"
    match = _MAINTAINER.fullmatch(text)
    if match is None:
        raise OptionError(f"maintainer {text!r} does not read 'Name <address>'")
    return match[1].strip() or match[2], match[2]
