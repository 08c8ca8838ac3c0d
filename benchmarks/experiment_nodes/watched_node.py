"""Runs a generated safety node, unchanged, and notes what its rules are given and when.

The time of a message is the one that the node itself reads when it takes it; only with these times
can the rules be played again to the nanosecond. They are written to MCAP when the node has ended.
"""

from __future__ import annotations

import sys
from collections.abc import Callable
from importlib import import_module
from pathlib import Path
from typing import Any

from support.experiments.recording import Recorded, Recording

_RESET = ""
"""Stands in the place of a topic where the operator has asked for a reset."""


class Watch:
    """What the rules of a node were given."""

    def __init__(self) -> None:
        """Begin with nothing."""
        self.notes: list[tuple[int, str, bytes]] = []
        self.start: tuple[int, int, list[str]] = (0, 0, [])
        self.types: dict[str, str] = {}
        self._taken: tuple[str, bytes] = ("", b"")

    def subscription(
        self, topic: str, kind: type, callback: Callable[[bytes], None]
    ) -> Callable[[bytes], None]:
        """Return a callback that remembers the message which it passes on."""
        self.types[topic] = f"{kind.__module__.split('.')[0]}/msg/{kind.__name__}"

        def take(data: bytes) -> None:
            self._taken = (topic, bytes(data))
            callback(data)

        return take

    def monitor_class(self, base: Any) -> Any:
        """Return a class of monitors that note what they are given."""
        watch = self

        class Watched(base):  # type: ignore[misc]
            def __init__(self, start: int, emit: Any, grace: int = 0, latched: Any = ()) -> None:
                watch.start = (start, grace, sorted(latched))
                super().__init__(start, emit, grace, latched)

            def reset(self, now: int) -> bool:
                watch.notes.append((now, _RESET, b""))
                return bool(super().reset(now))

        for name in (each for each in dir(base) if each.startswith("on_")):
            setattr(Watched, name, self._noting(getattr(base, name)))
        return Watched

    def _noting(self, method: Any) -> Any:
        def take(monitor: Any, now: int, *values: Any) -> Any:
            self.notes.append((now, *self._taken))
            return method(monitor, now, *values)

        return take

    def write(self, path: Path, origin: int) -> None:
        """Write all of it, in the order in which it happened.

        Args:
            path: the file.
            origin: what the reports of the node add to the times of its monitor, in ns.
        """
        start, grace, latched = self.start
        told = {"start": True, "grace_ns": grace, "latched": latched}
        with Recording(path) as recording:
            recording.add_monitor(start + origin, told)
            for noted, topic, data in self.notes:
                now = noted + origin
                if topic == _RESET:
                    recording.add_monitor(now, {"reset": True})
                else:
                    recording.add(Recorded(topic, self.types[topic], now, now, data))


def main() -> None:
    """Run the node of a module until SIGINT, and write a file; further arguments are its own."""
    name, path, *arguments = sys.argv[1:]
    module = import_module(name)
    node_class = _node_class(module, name)
    watch = Watch()
    nodes: list[Any] = []

    class Watched(node_class):  # type: ignore[misc, valid-type]
        def __init__(self, **named: Any) -> None:
            nodes.append(self)
            super().__init__(**named)

        def create_subscription(
            self, msg_type: Any, topic: str, callback: Any, *rest: Any, **named: Any
        ) -> Any:
            if named.get("raw"):
                callback = watch.subscription(topic, msg_type, callback)
            return super().create_subscription(msg_type, topic, callback, *rest, **named)

    names = vars(module)
    names["ExplainedMonitor"] = watch.monitor_class(names["ExplainedMonitor"])
    # The runtime lies beside the generated package.
    run = vars(import_module("deros_runtime.process"))["run"]
    run(Watched, [name, *arguments], Watched.flush_reports)
    watch.write(Path(path), nodes[0]._core.runner.clock.origin)


def _node_class(module: Any, name: str) -> Any:
    words = name.rpartition(".")[2].split("_")
    return vars(module)["".join(each.capitalize() for each in words)]


if __name__ == "__main__":
    main()
