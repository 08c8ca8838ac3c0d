"""The standalone modules, joined to one text."""

from __future__ import annotations

import ast
import functools
from collections.abc import Iterable
from dataclasses import dataclass
from importlib.resources import files

PARTS = (
    "node",
    "command_line",
    "programs",
    "output",
    "guard",
    "process",
    "watch/logs",
    "watch/display",
    "watch/table",
    "supervisor",
    "command",
)
"""The modules, each after those it needs; the first one defines the rows of the table."""

HOSTS = ("hosts/far", "hosts/connection", "hosts/part", "hosts/starting", "hosts/starter")
_OF_CONTAINERS = ("containers/values", "containers/load", "containers/composition")


def module_names(
    arguments: bool = False,
    lookups: bool = False,
    lifecycle: bool = False,
    composition: bool = False,
    launch_files: bool = False,
    xacro: bool = False,
    made_files: bool = False,
    hosts: bool = False,
    waits: bool = False,
) -> tuple[str, ...]:
    """Return the modules of a script, in their order.

    Args:
        arguments: whether its system has any; those before the command line define what it
            declares.
        lookups: whether something is looked up where it is started.
        lifecycle: whether managed nodes are brought up when it is started.
        composition: whether nodes are loaded into containers.
        launch_files: whether existing launch files are started.
        xacro: whether xacro makes values of parameters.
        made_files: whether files are made before it is started.
        hosts: whether its system is spread over hosts.
        waits: whether programs wait for what is in the ROS graph.
    """
    return (
        PARTS[0],
        *(("launching",) if launch_files else ()),
        *(("made/xacro",) if xacro or made_files else ()),
        *(("made/substituting", "made/under", "made/below", "made/files") if made_files else ()),
        *(("arguments",) if arguments or lookups else ()),
        *(("start",) if lookups else ()),
        *PARTS[1:],
        *(("assistant",) if lifecycle or composition or waits else ()),
        *(("bring_up", "lifecycle") if lifecycle or composition else ()),
        *(_OF_CONTAINERS if composition else ()),
        *(("waits/graph", "waits/waiting") if waits else ()),
        *(HOSTS if hosts else ()),
    )


@dataclass(frozen=True, slots=True)
class Part:
    """A module without its imports: its title and its code."""

    title: str
    code: str


@dataclass(frozen=True, slots=True)
class Runtime:
    """All modules in one: their merged imports, and the parts."""

    future: str
    imports: str
    parts: tuple[Part, ...]


@functools.cache
def runtime(names: tuple[str, ...] = PARTS) -> Runtime:
    """Read the modules; drop imports of each other, and merge all others."""
    package = files("deros.generators.system.script.standalone")
    parts: list[Part] = []
    imports: list[ast.Import | ast.ImportFrom] = []
    for name in names:
        text = (package / f"{name}.py").read_text(encoding="utf-8")
        module = ast.parse(text)
        own = [s for s in module.body if isinstance(s, (ast.Import, ast.ImportFrom))]
        imports += own
        code = "\n".join(text.split("\n")[own[-1].end_lineno :]).strip("\n")
        title = (ast.get_docstring(module) or "").rstrip(".")
        parts.append(Part(title, code))
    future, merged = merged_imports(imports)
    return Runtime(future, merged, tuple(parts))


def merged_imports(imports: Iterable[ast.stmt]) -> tuple[str, str]:
    """Return import statements in the order of ament: by module, in either form.

    Those from ``__future__`` come first, and signal is left to the script, which needs it earlier.
    """
    plain: set[str] = set()
    members: dict[str, set[str]] = {}
    for statement in imports:
        if isinstance(statement, ast.Import):
            plain |= {alias.name for alias in statement.names}
        elif isinstance(statement, ast.ImportFrom) and statement.level == 0 and statement.module:
            names = {alias.name for alias in statement.names}
            members.setdefault(statement.module, set()).update(names)
    first = members.pop("__future__", set())
    plain.discard("signal")
    lines = [(name, f"import {name}") for name in plain]
    for module, names in members.items():
        lines.append((module, f"from {module} import {', '.join(sorted(names, key=str.lower))}"))
    future = f"from __future__ import {', '.join(sorted(first))}"
    return future, "\n".join(line for _, line in sorted(lines, key=lambda each: each[0].lower()))
