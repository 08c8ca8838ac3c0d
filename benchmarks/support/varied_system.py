"""Write a system with many bool arguments, of which conditions use a few each.

Nodes, topics, connections, parameters and subsystems have conditions; the node types disagree in
QoS, so that the combinations have faults of their own. The same numbers give the same system.
"""

from __future__ import annotations

import random
from pathlib import Path

TYPES = {
    "camera": "node camera : eyes publishes topic out : std_msgs.Int32",
    "radar": "node radar : eyes publishes topic out : std_msgs.Int32 qos best_effort",
    "mapper": "node mapper : maps parameters name rate : double = 1.0 in [0, 6]"
    " subscribes topic in : std_msgs.Int32",
}

_TOPICS = 10


class _Writer:
    """Writes a system, with a condition wherever one may be until there are enough."""

    def __init__(self, arguments: int, conditions: int) -> None:
        self._random = random.Random(arguments)
        self._names = [f"a{number}" for number in range(arguments)]
        self.left = conditions

    def text(self) -> str:
        lines = ["system Varied", 'imports import "*.rnd"']
        defaults = (self._random.choice(("true", "false")) for _ in self._names)
        lines += map("argument {} : bool = {}".format, self._names, defaults)
        lines.append("topics")
        lines += [f"  topic /t{number}{self._when(0.4)}" for number in range(_TOPICS)]
        part = 0
        while self.left:
            lines += [f"subsystem part{part}{self._when(0.6)} {{", *self._node("one")]
            lines += [*self._node("two"), "}"]
            part += 1
        return "\n".join(lines) + "\n"

    def _node(self, name: str) -> list[str]:
        kind = self._random.choice(("camera", "mapper", "radar", "mapper"))
        lines = [f"  node {name} : {kind}{self._when(0.6)}"]
        if kind == "mapper":
            rate = self._random.choice((2, 9, 3))
            lines.append(f"    parameters param rate = {rate}{self._when(0.5)}")
        lines.append("    wirings")
        port = "in" if kind == "mapper" else "out"
        for chance in (0.5, 1.0)[: self._random.choice((1, 1, 2))]:
            topic = self._random.randrange(_TOPICS)
            lines.append(f"      connect {port} to /t{topic}{self._when(chance)}")
        return lines

    def _when(self, chance: float) -> str:
        if not self.left or self._random.random() >= chance:
            return ""
        self.left -= 1
        used = self._random.sample(self._names, self._random.choice((1, 1, 2, 2, 3)))
        terms = [f"not {name}" if self._random.random() < 0.3 else name for name in used]
        return " when " + self._random.choice((" and ", " or ")).join(terms)


def write(directory: Path, arguments: int, conditions: int) -> Path:
    """Write a system with so many arguments and conditions; return its path."""
    for name, text in TYPES.items():
        (directory / f"{name}.rnd").write_text(text + "\n", encoding="utf-8")
    path = directory / "varied.system"
    path.write_text(_Writer(arguments, conditions).text(), encoding="utf-8")
    return path
