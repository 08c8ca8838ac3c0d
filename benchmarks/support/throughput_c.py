"""The generated C monitor beside one written by hand in C, and a floor, in one program.

All are compiled on the spot and take the same drive, in turns; see ``throughput_c/driver.c``.
"""

from __future__ import annotations

import statistics
import struct
from collections import defaultdict
from collections.abc import Sequence
from pathlib import Path

from deros.generators.monitor.c.code.view import MonitorView, monitor_view
from deros.generators.monitor.c.interface import render_monitor
from deros.rules.program import walk
from deros.rules.program.ir import Program
from support.compiling import compile_c, section_sizes
from support.processes import run
from support.throughput_by_hand import Event
from support.throughput_rules import RULES_OF_A_ROBOT, Message
from support.throughput_timing import Memory, Row, Timing

NOTHING, GENERATED, BY_HAND = "nothing, in C", "generated, in C", "by hand, in C"
"""The names of the rows."""

_SOURCES = Path(__file__).resolve().parents[1] / "throughput_c"
_TURN_NS = 20_000_000
_KINDS = ("trigger", "reset", "refused", "clock_step")

_TOPICS = {
    "/imu": ("IMU", "imu", "vector"),
    "/odometry": ("ODOMETRY", "odometry", "number"),
    "/front": ("FRONT", "front", "number"),
    "/plc/mode": ("MODE", "mode", "integer"),
    "/plc/stop_button": ("STOP_BUTTON", "stop_button", "integer"),
    "/plc/bumper": ("BUMPER", "bumper", "integer"),
    "/plc/arm": ("ARM", "arm", "integer"),
}
"""Of each topic, in the drive's order: the enumerator, the function by hand, the one that does
nothing."""

_NUMBERS = list(_TOPICS)

_BY_HAND = """\
#include "by_hand.h"
static by_hand hand;
void by_hand_emit(int64_t t, by_hand_kind kind, by_hand_action action, by_hand_behaviour behaviour)
{
  happened(t, (int)kind, (int)action, (int)behaviour);
}
static void start_by_hand(void) { by_hand_start(&hand, 0); }
"""

_GENERATED = """\
#include "{prefix}_monitor.h"
static {prefix}_monitor generated;
void {prefix}_emit(void *owner, int64_t t, {prefix}_kind kind, uint32_t site)
{{
  const bool none = site == {macro}_SITE_NONE;
  (void)owner;
  happened(t, (int)kind, none ? {actions} : (int){prefix}_sites[site].action,
    none ? {behaviours} : (int){prefix}_sites[site].behaviour);
}}
static void start_generated(void) {{ {prefix}_start(&generated, 0, 0, 0); }}
"""

_HEAD = """\
#include "contenders.h"
#include "nothing.h"
static char nobody;
static void start_nothing(void) { nobody = 0; }
"""


class Bench:
    """The program that measures the monitors of one set of rules.

    Args:
        rules: how many.
        program: what they mean.
        folder: where it is built; it must be empty.

    Raises:
        ProcessError: if it cannot be compiled.
    """

    def __init__(self, rules: int, program: Program, folder: Path) -> None:
        """Write and compile it."""
        view = monitor_view(program)
        self._rules = rules
        self._folder = folder
        self._actions = [*(action.name for action in program.actions), ""]
        self._behaviours = [*(each.name for each in walk.behaviours(program)), ""]
        self._objects = {GENERATED: folder / "generated.o"}
        for name, text in render_monitor(program).items():
            (folder / name).write_text(text, encoding="utf-8")
        compile_c([folder / f"{view.prefix}_monitor.c"], self._objects[GENERATED])
        if rules == RULES_OF_A_ROBOT:
            self._objects[BY_HAND] = folder / "by_hand.o"
            compile_c([_SOURCES / "by_hand.c"], self._objects[BY_HAND])
        contenders = folder / "contenders.c"
        contenders.write_text(self._contenders(view), encoding="utf-8")
        # The functions that do nothing are compiled apart, too, so that they are called.
        sources = [contenders, *(_SOURCES / name for name in ("driver.c", "nothing.c"))]
        include = [folder, _SOURCES]
        compile_c([*sources, *self._objects.values()], folder / "driver", include)

    def measure(self, drive: Sequence[Message], repeat: int) -> list[Row]:
        """Let each monitor take the drive in turns; return the rows."""
        printed = run([*self._command(drive), str(repeat), str(_TURN_NS)])
        costs: dict[str, list[float]] = defaultdict(list)
        sizes: dict[str, int] = {}
        for line in printed.splitlines():
            name, cost, size = line.split("\t")
            costs[name].append(float(cost))
            sizes[name] = int(size)
        return [
            Row(
                self._rules,
                name,
                Timing(len(drive), statistics.median(costs[name]), None, None),
                language="C",
                memory=self._memory(name, sizes[name]),
            )
            for name in costs
        ]

    def events(self, drive: Sequence[Message]) -> dict[str, list[Event]]:
        """Return what each monitor says about a drive, by its name."""
        said: dict[str, list[Event]] = {name: [] for name in self._objects}
        for line in run(self._command(drive)).splitlines():
            name, t, kind, action, behaviour = line.split("\t")
            event = (
                int(t),
                _KINDS[int(kind)],
                self._actions[int(action)],
                self._behaviours[int(behaviour)],
            )
            said[name].append(event)
        return said

    def _command(self, drive: Sequence[Message]) -> list[str]:
        file = self._folder / "drive"
        packed = (
            struct.pack("=qq4d", t, _NUMBERS.index(topic), *values, *[0.0] * (4 - len(values)))
            for t, topic, values in drive
        )
        file.write_bytes(b"".join(packed))
        return [str(self._folder / "driver"), str(file)]

    def _memory(self, name: str, size: int) -> Memory | None:
        if name not in self._objects:
            return None
        return Memory(size, section_sizes(self._objects[name]))

    # The bindings ---------------------------------------------------------------------------------

    def _contenders(self, view: MonitorView) -> str:
        """Return the source that puts the monitors behind the functions of contenders.h."""
        functions = {each.handler.topic: each.handler for each in view.messages}
        topics = [topic for topic in _TOPICS if topic in functions]
        nothing = {t: (f"nothing_{_TOPICS[t][2]}", _values(t)) for t in topics}
        generated = {
            topic: (
                functions[topic].function,
                _values(topic, [p.declarations[0] for p in functions[topic].parameters]),
            )
            for topic in topics
        }
        text = _HEAD + _GENERATED.format(
            prefix=view.prefix,
            macro=view.macro,
            actions=len(self._actions) - 1,
            behaviours=len(self._behaviours) - 1,
        )
        text += _take("nothing", "nobody", nothing) + _take("generated", "generated", generated)
        rows = [(NOTHING, "nothing", "nobody"), (GENERATED, "generated", "generated")]
        if BY_HAND in self._objects:
            calls = {topic: (f"by_hand_{_TOPICS[topic][1]}", _values(topic)) for topic in topics}
            text += _BY_HAND + _take("by_hand", "hand", calls)
            rows.append((BY_HAND, "by_hand", "hand"))
        lines = [
            f'  {{"{name}", sizeof({state}), start_{each}, take_{each}}},\n'
            for name, each, state in rows
        ]
        table = f"const contender contenders[] = {{\n{''.join(lines)}}};\n"
        return f"{text}{table}const size_t contender_count = {len(rows)};\n"


def _values(topic: str, declarations: Sequence[str] | None = None) -> list[str]:
    """Return the arguments that a topic's function takes after the time.

    Args:
        topic: the topic.
        declarations: the parameters, if they are to be checked against those that the drive has.
    """
    kind = _TOPICS[topic][2]
    if kind == "vector":
        values = [f"each->values[{i}]" for i in range(4)]
    elif kind == "number":
        values = ["each->values[0]"]
    else:
        values = ["(int64_t)each->values[0]"]
    if declarations is not None and len(declarations) != len(values):
        raise ValueError(f"the drive has {len(values)} values of {topic}, not {declarations}")
    return values


def _take(name: str, state: str, calls: dict[str, tuple[str, list[str]]]) -> str:
    """Return the function that hands a message of the drive to a monitor."""
    cases = "".join(
        f"    case {_TOPICS[topic][0]}:\n"
        f"      {function}(&{state}, each->t, {', '.join(values)});\n"
        "      break;\n"
        for topic, (function, values) in calls.items()
    )
    return (
        f"static void take_{name}(const message *each)\n"
        f"{{\n  switch (each->topic) {{\n{cases}    default:\n      break;\n  }}\n}}\n"
    )


def missing_rows(rules: int) -> list[Row]:
    """Return the rows of a machine that has no C compiler."""
    names = (NOTHING, GENERATED, BY_HAND) if rules == RULES_OF_A_ROBOT else (NOTHING, GENERATED)
    return [Row(rules, name, None, language="C", why="no C compiler") for name in names]
