"""A process that plays sensors: it publishes serialized messages as its input says.

    python sensor.py TOPIC=PACKAGE/msg/TYPE …

Each line of the input is a command in JSON, and is answered by one line when it is done:

    {"match": TOPIC, "count": N}                         wait until so many, from 1 on, listen
    {"play": TOPIC, "messages": [BASE64, …], "rate": HZ} publish them in turn, for ever
    {"quiet": TOPIC}                                     play nothing any more; answer how many
    {"send": TOPIC, "messages": [BASE64, …], "times": N, "rate": HZ}
                                                         publish them in turn, N messages in all

It continues to publish while it waits for subscriptions: slow discovery does not silence a sensor.
It does not interpret the messages, so it can publish invalid ones. It ends with its input. Tests
kill or freeze this process.
"""

from __future__ import annotations

import base64
import importlib
import json
import math
import os
import select
import sys
import time
from dataclasses import dataclass, field
from typing import Any

import rclpy
from rclpy.qos import QoSProfile
from rclpy.signals import SignalHandlerOptions

CATCH_UP = 0.025
"""Seconds by which a player may be late and still play all that it has missed."""

LOOK = 0.01
"""Seconds between two looks for listeners: the graph has no event to await without an executor."""


@dataclass
class Player:
    """One topic: what is published on it, and when next; and how many listeners are awaited."""

    publisher: Any
    messages: list[bytes] = field(default_factory=list)
    period: float = 0.0
    due: float = math.inf
    left: float = math.inf
    count: int = 0
    awaited: int = 0

    def start(self, command: dict[str, Any]) -> None:
        """Play the messages of a command, beginning now."""
        self.messages = [base64.b64decode(text) for text in command["messages"]]
        self.period = 1.0 / command["rate"]
        self.left = command.get("times", math.inf)
        self.due, self.count = time.monotonic(), 0

    def play(self, now: float) -> None:
        """Publish what is due."""
        self.due = max(self.due, now - CATCH_UP)
        while self.due <= now:
            self.publisher.publish(self.messages[self.count % len(self.messages)])
            self.count += 1
            self.due += self.period
            if self.count >= self.left:
                self.due = math.inf
                answer(self.count)

    def wakes(self, now: float) -> float:
        """Return when there is something to do again."""
        return min(self.due, now + LOOK) if self.awaited else self.due

    def look(self) -> None:
        """Answer once the awaited listeners are there."""
        if self.awaited and self.publisher.get_subscription_count() >= self.awaited:
            self.awaited = 0
            answer(1)


def answer(result: int) -> None:
    """Tell that a command is done."""
    print(result, flush=True)


def obey(command: dict[str, Any], players: dict[str, Player]) -> None:
    """Do what one line of the input says."""
    (verb,) = command.keys() & {"match", "play", "quiet", "send"}
    player = players[command[verb]]
    if verb == "match":
        player.awaited = command["count"]
    elif verb == "send":
        player.start(command)
    elif verb == "play":
        player.start(command)
        answer(1)
    else:
        player.due = math.inf
        answer(player.count)


def message_type(name: str) -> Any:
    """Return the class of a message type, PACKAGE/msg/TYPE."""
    package, _, kind = name.split("/")
    return getattr(importlib.import_module(f"{package}.msg"), kind)


def main(topics: list[str]) -> None:
    """Play until the input ends."""
    rclpy.init(signal_handler_options=SignalHandlerOptions.NO)
    node = rclpy.create_node(f"sensor_{os.getpid()}")
    players = {}
    for topic, _, name in (each.partition("=") for each in topics):
        publisher = node.create_publisher(message_type(name), topic, QoSProfile(depth=10))
        players[topic] = Player(publisher)
    answer(len(players))
    pending = bytearray()
    while True:
        now = time.monotonic()
        due = min(player.wakes(now) for player in players.values())
        wait = None if due == math.inf else max(due - now, 0.0)
        if select.select([0], [], [], wait)[0]:
            read = os.read(0, 1 << 20)
            if not read:
                rclpy.shutdown()  # and say so to everybody
                return
            pending += read
            if b"\n" in read:  # a command of megabytes comes in many pieces
                *lines, pending = pending.split(b"\n")
                for line in lines:
                    obey(json.loads(line), players)
        now = time.monotonic()
        for player in players.values():
            if player.due <= now:
                player.play(now)
            player.look()


if __name__ == "__main__":
    main(sys.argv[1:])
