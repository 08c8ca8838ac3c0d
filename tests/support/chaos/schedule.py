"""What happens in a round: drawn from a seed, kept as a file, played as often as one likes."""

from __future__ import annotations

import json
import random
from collections.abc import Callable, Mapping
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import Any

from tests.support.chaos.links import CONTROLLER_OK, GATE, LINKS, SAFETY, Link

WINDOW = 5.5
"""Seconds of a round in which faults come and go; the robot drives when they begin."""

LAST_BEGIN = 2.5
LONGEST = 2.5

GENERATED = ("safety", "gate")
"""The nodes that are killed and started again: those that are under test."""

NODES = (*GENERATED, "imu_driver", "odometry_driver", "lidar_driver", "plc", "mission_controller")
"""The nodes that are let hang or starve; the arbiter and the simulator are the actuator."""


@dataclass(frozen=True)
class Fault:
    """One fault.

    Attributes:
        kind: a name in :data:`KINDS`.
        target: a node, or the topic of a link.
        domain: where the link ends, or a foreign publisher lives.
        begin: seconds from the beginning of the round.
        duration: seconds until it is healed; of no meaning for what heals by itself.
        amount: a probability, a delay in s, a count or a step in s, as the kind has it.
    """

    kind: str
    target: str = ""
    domain: str = ""
    begin: float = 0.0
    duration: float = 0.0
    amount: float = 0.0

    @property
    def link(self) -> Link:
        """The link that it concerns."""
        return Link(self.target, self.domain)

    def __str__(self) -> str:
        """Return it as a reader of the table sees it."""
        place = f"{self.target} in {self.domain}" if self.domain else self.target
        amount = f" {self.amount:g}" if self.amount else ""
        lasts = f" for {self.duration:.1f} s" if self.duration else ""
        return f"{self.kind}{amount} {place}".rstrip() + f" at {self.begin:.1f} s{lasts}"


@dataclass(frozen=True)
class Provocation:
    """What breaks a rule: a lever of the world that is pulled, and let go after a while."""

    kind: str
    begin: float = 0.0
    duration: float = 0.0

    def __str__(self) -> str:
        """Return it as a reader of the table sees it."""
        return f"{self.kind} at {self.begin:.1f} s for {self.duration:.1f} s"


@dataclass(frozen=True)
class Schedule:
    """A round."""

    seed: int
    number: int
    faults: tuple[Fault, ...]
    provocation: Provocation

    @property
    def blocked(self) -> tuple[Link, ...]:
        """Links that carry nothing throughout: the mission never learns that it is to stop."""
        return (Link(CONTROLLER_OK.name, "plant"),)

    def save(self, path: Path) -> None:
        """Write it to a file, each fault on a line."""
        parts = asdict(self)
        faults = ",\n  ".join(json.dumps(each) for each in parts.pop("faults"))
        text = f'{json.dumps(parts)[:-1]}, "faults": [\n  {faults}\n]}}\n'
        path.write_text(text, encoding="utf-8")

    @staticmethod
    def load(path: Path) -> Schedule:
        """Read it from a file."""
        data: dict[str, Any] = json.loads(path.read_text(encoding="utf-8"))
        return Schedule(
            data["seed"],
            data["number"],
            tuple(Fault(**fault) for fault in data["faults"]),
            Provocation(**data["provocation"]),
        )


Draw = Callable[[random.Random], Fault]


def _node_fault(kind: str, nodes: tuple[str, ...]) -> Draw:
    def draw(chance: random.Random) -> Fault:
        return Fault(kind, chance.choice(nodes))

    return draw


def _link_fault(kind: str, amounts: tuple[float, ...]) -> Draw:
    def draw(chance: random.Random) -> Fault:
        # The half of all links are those of sensors; those of the gate matter as much.
        target = chance.choice((SAFETY, GATE, "plant"))
        link = chance.choice([link for link in LINKS if link.target == target])
        return Fault(kind, link.topic, target, amount=chance.choice(amounts))

    return draw


FOREIGN: Mapping[tuple[str, str], tuple[str, ...]] = {
    ("/safety/stop", GATE): ("false",),
    ("/safety/low_speed", GATE): ("false",),
    ("/safety/heartbeat", GATE): ("constant", "counting"),
    ("/odometry", SAFETY): ("standing",),
    ("/scan", SAFETY): ("free",),
}
"""What a second publisher may say, and where: always what would keep the robot moving."""


def _second_publisher(chance: random.Random) -> Fault:
    topic, domain = chance.choice(sorted(FOREIGN))
    words = FOREIGN[topic, domain]
    return Fault("second publisher", topic, domain, amount=chance.randrange(len(words)))


def _clock_step(chance: random.Random) -> Fault:
    return Fault("clock step", amount=chance.choice((-86_400.0, -3_600.0, -5.0, 5.0, 3_600.0, 1e8)))


KINDS: Mapping[str, Draw] = {
    "kill": _node_fault("kill", GENERATED),
    "restart": _node_fault("restart", GENERATED),
    "stop": _node_fault("stop", NODES),
    "starve": _node_fault("starve", NODES),
    "drop": _link_fault("drop", (0.3, 0.7, 1.0)),
    "duplicate": _link_fault("duplicate", (1.0, 5.0)),
    "delay": _link_fault("delay", (0.05, 0.2, 0.8)),
    "replay": _link_fault("replay", (1.0,)),
    "second publisher": _second_publisher,
    "clock step": _clock_step,
    "full disk": lambda _chance: Fault("full disk"),
}
"""How a fault of each kind is drawn, but for its times."""

Provocations = Mapping[str, tuple[float, float]]

PROVOCATIONS: Provocations = {
    "obstacle in the stop zone": (0.4, 4.0),
    "obstacle in the collision zone": (0.4, 4.0),
    "front bumper": (0.2, 3.0),
    "stop button": (0.2, 3.0),
    "rollover": (0.3, 3.0),
    "far too fast": (0.8, 3.0),
    "too fast": (4.5, 5.0),
    "nothing": (0.0, 0.0),
}
"""What breaks rules, with the shortest and the longest time for which it is drawn."""

WITH_JOYSTICK: Provocations = {**PROVOCATIONS, "joystick": (0.5, 3.0)}
"""The same where an operator may take over, too."""


def draw(
    seed: int, number: int, faults: int = 2, provocations: Provocations = PROVOCATIONS
) -> Schedule:
    """Return a round, which depends on the arguments alone."""
    chance = random.Random(f"{seed}:{number}")
    drawn = []
    for _ in range(faults):
        kind = chance.choice(tuple(KINDS))
        fault = KINDS[kind](chance)
        times = {
            "begin": round(chance.uniform(0.0, LAST_BEGIN), 2),
            "duration": round(chance.uniform(0.3, LONGEST), 2),
        }
        if kind in {"kill", "restart"}:
            times["duration"] = 0.0
        drawn.append(Fault(**{**asdict(fault), **times}))
    kind = chance.choice(tuple(provocations))
    shortest, longest = provocations[kind]
    latest = LAST_BEGIN if longest < WINDOW - 1.0 else 0.3
    provocation = Provocation(
        kind,
        round(chance.uniform(0.0, latest), 2),
        round(chance.uniform(shortest, longest), 2),
    )
    return Schedule(seed, number, tuple(drawn), provocation)
