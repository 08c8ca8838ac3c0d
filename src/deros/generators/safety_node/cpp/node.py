"""The C++ twins of the nodes of the Python target, which differ only in their type names."""

from __future__ import annotations

from deros.generators.api.protocol import Options
from deros.systems.safety_nodes import CPP_SUFFIX


def twin_options(options: Options) -> dict[str, str]:
    """Return the options that name the Python twin: ``guard`` is that of ``guard_cpp``."""
    named = {
        name: options[name].removesuffix(CPP_SUFFIX)
        for name in ("package", "node")
        if name in options
    }
    return {**options, **named}
