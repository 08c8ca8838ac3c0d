"""The C++ twins of the nodes that the Python target makes: other type names, all else the same."""

from __future__ import annotations

import dataclasses

from deros.diagnostics import SourceFile
from deros.generators.protocol import Options
from deros.metamodels.node import NodeType
from deros.monitor.gates import CPP_SUFFIX


def twin_options(options: Options) -> dict[str, str]:
    """Return the options that name the Python twin: ``guard`` is that of ``guard_cpp``."""
    named = {
        name: options[name].removesuffix(CPP_SUFFIX)
        for name in ("package", "node")
        if name in options
    }
    return {**options, **named}


def cpp_twin(node: NodeType) -> NodeType:
    """Return the node type in C++: it stands where the Python one stood, by one word more."""
    name, package = f"{node.name}{CPP_SUFFIX}", f"{node.package}{CPP_SUFFIX}"
    source = SourceFile(f"{name}.rnd", node.source.text)
    return dataclasses.replace(node, name=name, package=package, source=source)
