"""Checks of environment variables that keep the nodes of one system from hearing each other."""

from __future__ import annotations

from collections.abc import Iterator

from deros import codes
from deros.diagnostics import Diagnostic, Related, report
from deros.models.programs import Variable
from deros.systems.flat import FlatNode, FlatSystem
from deros.validators.findings.hints import SHOWN

_WORDS = {
    "ROS_DOMAIN_ID": ("domain", "nodes of different domains do not find each other"),
    "RMW_IMPLEMENTATION": (
        "middleware",
        "nodes with different middleware may not find each other, or not understand each other",
    ),
}


def check_separation(flat: FlatSystem) -> Iterator[Diagnostic]:
    """Yield the finding that nodes of one system are in different domains, or middleware."""
    for name, (what, consequence) in _WORDS.items():
        by_value: dict[str | None, list[tuple[FlatNode, Variable | None]]] = {}
        for node in flat.nodes:
            variable = next((each for each in node.environment if each.name == name), None)
            value = None if variable is None else variable.value.text
            by_value.setdefault(value, []).append((node, variable))
        if len(by_value) < 2:
            continue
        settings = [each for found in by_value.values() for _, each in found if each is not None]
        listed = "; ".join(f"{_value(value)}: {_names(found)}" for value, found in by_value.items())
        others = dict.fromkeys(each.span for each in settings if each.span != settings[0].span)
        yield report(
            codes.NODES_APART,
            f"the nodes of the system differ in their {what} ({name}), {listed}: {consequence}",
            settings[0].span,
            f"set '{name}' once, at the head of the system",
            tuple(Related(span, "set here, too") for span in list(others)[:SHOWN]),
        )


def _value(value: str | None) -> str:
    return "that of whoever starts it" if value is None else f'"{value}"'


def _names(found: list[tuple[FlatNode, Variable | None]]) -> str:
    names = ", ".join(f"'{node.full_name}'" for node, _ in found[:SHOWN])
    return f"{names} and {len(found) - SHOWN} more" if len(found) > SHOWN else names
