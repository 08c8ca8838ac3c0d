"""The check of the class that a container loads."""

from __future__ import annotations

import re
from collections.abc import Iterator

from deros import codes
from deros.diagnostics import Diagnostic, report
from deros.models.common import Name

_CLASS = re.compile(r"[A-Za-z_]\w*(?:::[A-Za-z_]\w*)*", re.ASCII)


def plugin_findings(plugin: Name | None) -> Iterator[Diagnostic]:
    """Yield the finding that a plugin is not the name of a class, as C++ writes one."""
    if plugin is not None and not _CLASS.fullmatch(plugin.text):
        yield report(
            codes.BAD_PLUGIN,
            f"'{plugin.text}' cannot be the name of a class",
            plugin.span,
            "write it as RCLCPP_COMPONENTS_REGISTER_NODE has it: 'namespace::Class'",
        )
