"""How long the generated decoders take for a message, beside what rclpy takes to build it whole.

One process; each message is decoded and built in turns, and the median over all turns counts.
"""

from __future__ import annotations

import argparse
import json
import os
import platform
import statistics
import sys
import time
from collections.abc import Callable, Iterator, Sequence
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import Any

from nav_msgs.msg import Odometry
from rclpy.serialization import deserialize_message, serialize_message
from rich.console import Console
from rich.table import Table
from sensor_msgs.msg import Imu, JointState, LaserScan, PointCloud2, PointField
from std_msgs.msg import Header

from deros.generators.decoder.python.interface import Topic, render_decoders
from deros.interfaces.fields import FieldPath
from deros.interfaces.store import InterfaceStore
from deros.interfaces.types import InterfaceType

FieldPaths = Sequence[FieldPath]


@dataclass(frozen=True, slots=True)
class Row:
    """One message: what is read of it, its size in bytes, and the medians in microseconds."""

    name: str
    size: int
    decode: float
    build: float

    @property
    def ratio(self) -> float:
        """How many times as long it takes to build the message."""
        return self.build / self.decode


def cases() -> Iterator[tuple[str, Any, FieldPaths]]:
    """Yield what is read, of which message, by which paths."""
    header = Header(frame_id="base_link")
    orientation = [("orientation", axis) for axis in "xyzw"]
    yield "Imu: orientation", Imu(header=header), orientation
    odometry = Odometry(header=header, child_frame_id="wheels")
    yield "Odometry: twist.twist.linear.x", odometry, [("twist", "twist", "linear", "x")]
    joints = JointState(
        header=header, name=[f"joint_{number}" for number in range(6)], position=[0.1] * 6
    )
    yield "JointState, 6 joints: position[2]", joints, [("position", 2)]
    scan = LaserScan(header=header, ranges=[1.0] * 2000, intensities=[1.0] * 2000)
    names = ("ranges", "angle_min", "angle_increment", "range_min", "range_max")
    yield "LaserScan, 2,000 beams: all that nearest() reads", scan, [(name,) for name in names]
    for megabytes in (1, 10):
        cloud = PointCloud2(header=header, fields=[PointField(name=name) for name in "xyzi"])
        cloud.data.frombytes(bytes(megabytes * 1_000_000))
        yield f"PointCloud2, {megabytes} MB: width, height", cloud, [("width",), ("height",)]


def measure(name: str, message: Any, paths: FieldPaths, turns: int) -> Row:
    """Return the medians for one message."""
    kind = type(message)
    topic = Topic(
        "topic", InterfaceType(kind.__module__.split(".")[0], "msg", kind.__name__), paths
    )
    module: dict[str, Any] = {}
    exec(render_decoders([topic], InterfaceStore()), module)
    decode = module[topic.function]
    data = serialize_message(message)
    decoding, building = [], []
    for _ in range(turns):
        decoding.append(_time(lambda: decode(data), 20))
        building.append(_time(lambda: deserialize_message(data, kind), 1))
    return Row(name, len(data), statistics.median(decoding), statistics.median(building))


def _time(function: Callable[[], object], repeat: int) -> float:
    """Return the microseconds that a call takes."""
    start = time.perf_counter_ns()
    for _ in range(repeat):
        function()
    return (time.perf_counter_ns() - start) / repeat / 1e3


def main(arguments: Sequence[str] | None = None) -> int:
    """Print the table."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--turns", type=int, default=300, help="of each (%(default)s)")
    parser.add_argument("--json", type=Path, metavar="FILE", help="write all results there, too")
    options = parser.parse_args(arguments)
    rows = [measure(*case, options.turns) for case in cases()]
    table = Table(title="Microseconds per message, median", title_justify="left", pad_edge=False)
    table.add_column("")
    for head in ("bytes", "decoder", "whole message", "ratio"):
        table.add_column(head, justify="right")
    for row in rows:
        times = (f"{row.decode:.2f}", f"{row.build:.2f}", f"{row.ratio:.0f}")
        table.add_row(row.name, f"{row.size:,}", *times)
    Console(width=None if sys.stdout.isatty() else 120).print(table)
    if options.json is not None:
        machine = {
            "processors": os.cpu_count(),
            "system": platform.platform(),
            "python": platform.python_version(),
        }
        result = {"benchmark": "decoding", "machine": machine, "rows": list(map(asdict, rows))}
        options.json.write_text(json.dumps(result, indent=1) + "\n", encoding="utf-8")
    return 0


if __name__ == "__main__":
    sys.exit(main())
