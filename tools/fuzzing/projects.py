"""What mutants are made from: folders of models, with traces and messages for their rules."""

from __future__ import annotations

import json
import random
import struct
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from pathlib import Path

from deros.interfaces.fields import FieldPath, format_path
from deros.interfaces.store import InterfaceStore
from deros.interfaces.types import FLOAT_TYPES, INTEGER_RANGES, FieldType, InterfaceType
from deros.rules.program.ir import Program
from tests.support import mutations, paper
from tests.support.c_everything import NODE, RULES, SYSTEM

ROOT = Path(__file__).resolve().parents[2]
MODELS = (".rnd", ".system", ".deros")
DEFINITIONS = (".msg", ".srv", ".action")
INTERFACES = "interfaces"
"""The folder of a project whose message definitions are its own."""

_LONGEST_ARRAY = 4
_DEEPEST = 12


@dataclass(frozen=True)
class Project:
    """A folder of models.

    Attributes:
        name: different from those of the others.
        files: relative POSIX paths and what they hold.
    """

    name: str
    files: Mapping[str, bytes]

    @property
    def models(self) -> tuple[str, ...]:
        """The paths of its models, sorted."""
        return tuple(sorted(path for path in self.files if path.endswith(MODELS)))

    @property
    def definitions(self) -> tuple[str, ...]:
        """The paths of its message definitions, sorted."""
        return tuple(sorted(path for path in self.files if path.endswith(DEFINITIONS)))


def projects(kept: Path | None = None) -> tuple[Project, ...]:
    """Return the examples, the cases of the diagnostics, and the folders below ``kept``."""
    examples = sorted(each for each in (ROOT / "examples").iterdir() if each.is_dir())
    found = [_read(f"example_{each.name}", each) for each in examples]
    found.append(_read("cases", ROOT / "tests" / "cases"))
    found.append(_read("timelines", ROOT / "tests" / "data" / "timelines"))
    listings = {
        f"listing_{number}.{suffix}": text.encode()
        for suffix, texts in mutations.TEXTS.items()
        for number, text in enumerate(texts)
    }
    listings["everything.deros"] = RULES.encode()
    listings |= {"robot.rnd": NODE.encode(), "robot.system": SYSTEM.encode()}
    listings |= {f"{name}.deros": text.encode() for name, text in paper.RULES.items()}
    found.append(Project("listings", listings))
    found.append(Project("definitions", {path: text.encode() for path, text in _OWN.items()}))
    if kept is not None and kept.is_dir():
        folders = sorted(each for each in kept.iterdir() if each.is_dir())
        found += [_read(f"kept_{each.name}", each) for each in folders]
    return tuple(each for each in found if each.models)


def _read(name: str, folder: Path) -> Project:
    suffixes = (*MODELS, *DEFINITIONS)
    files = {
        path.relative_to(folder).as_posix(): path.read_bytes()
        for path in sorted(folder.rglob("*"))
        if path.is_file() and path.name.endswith(suffixes) and path.stat().st_size < 1 << 16
    }
    return Project(name, files)


_OWN = {
    f"{INTERFACES}/own_msgs/msg/Reading.msg": """\
# A reading with one field of each kind.
uint8 OK=0
uint8 STALE = 1
float64 LIMIT=1.5
string TEXT="a \\"text\\" # no comment"
std_msgs/Header header
uint8 status
float32[3] value [0.0, 1.0, 2.0]
float64[] readings
string<=10 name "none"
string[<=3] labels
Part[2] parts
Part[] more
bool valid true
""",
    f"{INTERFACES}/own_msgs/msg/Part.msg": "int16 level 3\ngeometry_msgs/Vector3 place\nchar c\n",
    f"{INTERFACES}/own_msgs/msg/Order.msg": "float64 speed\nPart part\nfloat32[4] gains\n",
    f"{INTERFACES}/own_msgs/srv/Ask.srv": "int32 a 1\n---\nint32 OK=1\nPart part\n",
    f"{INTERFACES}/own_msgs/action/Go.action": "float64 far\n---\nbool ok\n---\nPart[] parts\n",
    "robot.rnd": """\
node robot : robot
publishes
  topic /reading : own_msgs.Reading { value[1] [m/s] }
  topic /order : own_msgs.Order
subscribes
  topic /safe : own_msgs.Order
services service ask : own_msgs.Ask
actions action go : own_msgs.Go
""",
    "robot.system": """\
system Robot
imports import "robot.rnd"
topics topic /reading topic /order external topic /safe
subsystem Base { node robot : robot wirings
  connect /reading to /reading connect /order to /order connect /safe to /safe }
""",
    "robot.deros": """\
use "robot.system" import Robot
action stop publishes true on /stop : std_msgs.Bool latched
input r = topic /reading timeout 1 sec
input level = topic /reading.parts[1].level timeout 1 sec
input fast = topic /reading.value[1] timeout 1 sec
input all = topic /reading.readings timeout 1 sec
entity e {
  bad: r.status = STALE or level > 7 for 2 sec;
  far: all.max() > 3 or all.count() = 4 or fast >= 1.5 m/s;
  gone: r.missing() or level.missing() or fast.missing() or all.missing();
}
if e.bad or e.far or e.gone then { stop; };
gate /order -> /safe : own_msgs.Order rate 20 Hz {
  lost heartbeat for 0.3 sec: zero;
  stop: zero;
  lost input for 0.5 sec: limit speed to [-0.1, 0.1];
}
""",
}


# Traces -------------------------------------------------------------------------------------------


def trace(program: Program, length: int, chance: random.Random) -> str:
    """Return a trace of random messages on the topics that a program reads."""
    lines: list[str] = []
    t_ns = 0
    topics = sorted(program.topics)
    for _ in range(length if topics else 0):
        t_ns += chance.choice((0, 1, 10_000_000, 100_000_000, 1_000_000_000, 3_000_000_000))
        topic = chance.choice(topics)
        data = {
            format_path(leaf.path): _json_value(leaf.type, chance)
            for leaf in program.leaves
            if program.inputs[leaf.input].topic == topic and leaf.is_field and chance.random() < 0.8
        }
        known = {path: value for path, value in data.items() if value is not None}
        shown = f"{t_ns // 10**9}.{t_ns % 10**9:09d}"
        lines.append(json.dumps({"t": shown, "topic": topic, "data": known}))
    return "\n".join(lines) + "\n"


def _json_value(kind: FieldType, chance: random.Random) -> object:
    if isinstance(kind.base, InterfaceType):
        return None
    if kind.is_array:
        length = kind.size if kind.array == "fixed" else chance.randint(0, _LONGEST_ARRAY)
        if length is None or length > 1000:
            return None
        if kind.array == "bounded":
            length = min(length, kind.size or 0)
        return [_json_value(kind.element, chance) for _ in range(length)]
    if kind.base in FLOAT_TYPES:
        return chance.choice((0.0, -1.0, 1e-9, 0.5, 2.0, "NaN", "Infinity", chance.gauss(0, 3)))
    if kind.base == "bool":
        return chance.random() < 0.5
    if kind.base in INTEGER_RANGES:
        least, greatest = INTEGER_RANGES[kind.base]
        return chance.choice((least, greatest, 0, 1, chance.randint(0, 10)))
    return chance.choice(("", "a", "ERROR", "é", "\0"))


# Messages -----------------------------------------------------------------------------------------


def message(store: InterfaceStore, kind: InterfaceType, chance: random.Random) -> bytes:
    """Return a random message of a type, as it goes over the wire (little-endian plain CDR)."""
    data = bytearray()
    _write(data, store, FieldType(kind), chance, 0)
    return b"\0\1\0\0" + bytes(data)


def _write(
    data: bytearray, store: InterfaceStore, kind: FieldType, chance: random.Random, depth: int
) -> None:
    if kind.is_array:
        length = kind.size or 0 if kind.array == "fixed" else chance.randint(0, _LONGEST_ARRAY)
        if kind.array != "fixed":
            _number(data, "I", length)
        for _ in range(min(length, 1000)):
            _write(data, store, kind.element, chance, depth + 1)
    elif isinstance(kind.base, InterfaceType):
        definition = store.message(kind.base) if depth < _DEEPEST else None
        for _, inner in definition.fields if definition is not None else ():
            _write(data, store, inner, chance, depth + 1)
    elif kind.base in ("string", "wstring"):
        text = chance.choice((b"\0", b"a\0", b"base_link\0"))
        _number(data, "I", len(text))
        data += text
    elif kind.base in FLOAT_TYPES:
        _number(data, "f" if kind.base == "float32" else "d", chance.choice((0.0, 1.5, -1e30)))
    else:
        width = 8 if kind.base == "bool" else INTEGER_RANGES[kind.base][1].bit_length()
        letter = {7: "b", 8: "B", 15: "h", 16: "H", 31: "i", 32: "I", 63: "q", 64: "Q"}[width]
        _number(data, letter, chance.randint(0, 1))


def _number(data: bytearray, letter: str, value: float) -> None:
    size = struct.calcsize(letter)
    data += bytes(-len(data) % size)
    data += struct.pack(f"<{letter}", value)


def readable(
    program: Program,
) -> Iterator[tuple[str, InterfaceType, tuple[FieldPath, ...]]]:
    """Yield the topics that a program reads, each with its type and the paths that are read."""
    for topic, kind in sorted(program.topics.items()):
        paths = {
            leaf.path: None
            for leaf in program.leaves
            if program.inputs[leaf.input].topic == topic and leaf.path and leaf.is_field
        }
        if paths:
            yield topic, kind, tuple(paths)
