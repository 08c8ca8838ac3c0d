"""Codes of what the monitors that come with deros watch: load of nodes, and transforms."""

from __future__ import annotations

from deros.diagnostics import Severity, declare

LOAD_OF_UNKNOWN_NODE = declare(
    606, "load-of-unknown-node", "load of a node that the system does not have"
)
LOAD_WITHOUT_PROCESS = declare(
    607, "load-without-process", "load of a node whose process cannot be told"
)
LOAD_ELSEWHERE = declare(608, "load-elsewhere", "load of a node on another host")
LOAD_OF_SEVERAL_NODES = declare(
    609, "load-of-several-nodes", "load of a node that shares its process", Severity.INFO
)
TRANSFORM_OF_NOBODY = declare(
    612, "transform-of-nobody", "watched transform that no node broadcasts again and again"
)
