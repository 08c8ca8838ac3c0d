"""Generated gates in C++, compiled into one program that plays what happens to them."""

from __future__ import annotations

import struct
import subprocess
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from types import TracebackType
from typing import Any

from deros.generators.gate.cpp.generate import render
from deros.generators.gate.cpp.view import GateView, gate_view
from deros.generators.gate.python.interface import gate_nodes
from deros.generators.runtime.cpp import interface as runtime
from deros.generators.runtime.cpp.interface import CppRuntime
from deros.generators.safety_node.node import safety_node
from deros.generators.text.cpp import cpp_double
from deros.interfaces.types import InterfaceType
from deros.rules.compiler.scope.topics import SystemTopics
from deros.rules.gates.gate_engine import OutputKind
from deros.rules.program.ir import Action, Gate, Program
from tests.support import wire
from tests.support.cpp import WARNINGS, message_flags
from tests.support.gates import ACTIONS, READINGS, SOURCE, STORE, Happening, message_type
from tests.support.object_cache import compile_objects

STRICT = (*WARNINGS, "-Wshadow", "-Wsign-conversion", "-Wold-style-cast")
"""What the pure part of gates compiles with, beyond what all of C++ does."""

SANITIZED = ("-O0", "-g", "-fsanitize=address,undefined", "-fno-sanitize-recover=all")


_KINDS: tuple[OutputKind, ...] = ("pass", "limited", "zero", "send", "hold")
_CALLS = ("command", "state", "heartbeat", "advance", "no_safety_node", "reset", "reading")
_NEVER = 2**63 - 1
_IN_ONE_SOURCE = 24
"""Gates that are compiled together."""


def view_of(gate: Gate, package: str, actions: tuple[Action, ...] = ACTIONS) -> GateView:
    """Return the view of a gate in a package of its own."""
    program = Program("random", (), (), (), (), actions, (gate,))
    safety = safety_node(program, SystemTopics(()), {}, SOURCE)
    (node,) = gate_nodes(program, SystemTopics(()), safety)
    return gate_view(gate, replace(node, package=package), program, STORE, safety)


_INCLUDE = Path(runtime.__file__).parent / "include"
LOGIC = Path(runtime.__file__).parent / "src/gate_logic.cpp"
"""The class that plays the tables of all gates."""


def write_gate(view: GateView, folder: Path) -> Path:
    """Write table and message functions of a gate, on the runtime; return their source."""
    linked = CppRuntime(view.package, linked=True)
    include = folder / view.package
    include.mkdir(exist_ok=True)
    for part in ("table", "message"):
        header = include / f"{view.name}_{part}.hpp"
        header.write_text(render(f"{part}.hpp", view, linked), encoding="utf-8")
    source = folder / f"{view.package}_{view.name}.cpp"
    text = f'#include "{view.package}/{view.name}_table.hpp"\n'
    source.write_text(text + render("message.cpp", view, linked), encoding="utf-8")
    return source


# The program --------------------------------------------------------------------------------------

_PLAYER = """
#include <cstddef>
#include <cstdint>
#include <string>
#include "wire.hpp"

/// A gate that reads its events as bytes, and answers with what it publishes.
class Player
{
public:
  virtual ~Player() = default;
  virtual void start(std::int64_t t) = 0;
  virtual void play(wire::Bytes & from, wire::Bytes & to) = 0;
};
"""

_ADAPTER = """
namespace {package}
{{

using Gate = runtime::GateOf<{message_class}>;

class Adapter : public Player, public Gate::Output
{{
public:
  void start(std::int64_t t) override {{gate_.emplace({name}_table::TABLE, t, *this{tuned});}}

  void play(wire::Bytes & from, wire::Bytes & to) override
  {{
    std::uint8_t call = 0;
    std::int64_t t = 0;
    std::uint8_t topic = 0;
    bool is_given = false;
    bool is_trusted = false;
    std::uint64_t counter = 0;
    wire::get(from, call);
    wire::get(from, t);
    wire::get(from, topic);
    wire::get(from, is_given);
    wire::get(from, is_trusted);
    wire::get(from, counter);
    out_ = wire::Bytes{{}};
    count_ = 0;
    is_done_ = true;
    take(call, t, topic, is_given, is_trusted, counter, from);
    wire::put(to, count_);
    to.data += out_.data;
    wire::put(to, gate_->next_deadline());
    for (const bool applies : gate_->applying()) {{
      wire::put(to, applies);
    }}
    wire::put(to, is_done_);
  }}

private:
  using Command = Gate::Command;

  void take(
    std::uint8_t call, std::int64_t t, std::uint8_t topic, bool is_given, bool is_trusted,
    std::uint64_t counter, wire::Bytes & from)
  {{
    if (call == 0) {{
      Command command;
      if (is_given) {{
        wire::get(from, command);
        gate_->on_command(t, command, topic);
      }} else {{
        gate_->on_refused(t, topic);
      }}
      return;
    }}
{states}
{readings}
    switch (call) {{
      case 2: gate_->on_heartbeat(t, counter); break;
      case 4: gate_->on_no_safety_node(t); break;
      case 5: is_done_ = gate_->on_reset(t); break;
      default: gate_->advance(t);
    }}
    (void)topic;
    (void)is_trusted;
  }}

  void publish(runtime::Published what, const Command & command) override
  {{
    wire::put(out_, gate_->now());
    wire::put(out_, static_cast<std::uint8_t>(what));
    wire::put(out_, command);
    ++count_;
  }}

  builtin_interfaces::msg::Time stamp() override
  {{
    builtin_interfaces::msg::Time time;
    time.sec = static_cast<std::int32_t>(gate_->now() / 1000000000);
    time.nanosec = static_cast<std::uint32_t>(gate_->now() % 1000000000);
    return time;
  }}

  std::optional<Gate> gate_{{}};
  wire::Bytes out_{{}};
  std::uint32_t count_{{0}};
  bool is_done_{{true}};
}};

}}  // namespace {package}
"""

_STATE = """    if (call == 1 && topic == {topic}) {{
      const bool is_known = is_given;
      {type} message;
      if (is_given) {{wire::get(from, message);}}
      gate_->on_state(t, {{{active}}}, is_trusted);
      return;
    }}"""

_READING = """    if (call == 6 && topic == {topic}) {{
      const bool is_known = is_given;
      {type} message;
      if (is_given) {{wire::get(from, message);}}
      gate_->on_inputs(t, {{{numbers}}});
      return;
    }}"""

_MAIN = """
#include <cstdint>
#include <cstdio>
#include <memory>
#include <string>
#include "player.hpp"

{declarations}

namespace
{{

bool read(std::string & data, std::size_t count)
{{
  data.resize(count);
  return std::fread(data.data(), 1, count, stdin) == count;
}}

std::unique_ptr<Player> make(std::uint32_t number)
{{
  switch (number) {{
{cases}
    default: return nullptr;
  }}
}}

}}  // namespace

/// Play traces: their length; gate, start, number of happenings, and these.
int main()
{{
  std::uint32_t length = 0;
  wire::Bytes from;
  while (read(from.data, sizeof(length))) {{
    from.place = 0;
    wire::get(from, length);
    if (!read(from.data, length)) {{
      return 1;
    }}
    from.place = 0;
    std::uint32_t number = 0;
    std::int64_t start = 0;
    std::uint32_t count = 0;
    wire::get(from, number);
    wire::get(from, start);
    wire::get(from, count);
    const std::unique_ptr<Player> player = make(number);
    player->start(start);
    wire::Bytes to;
    for (std::uint32_t i = 0; i < count; ++i) {{
      player->play(from, to);
    }}
    wire::Bytes head;
    wire::put(head, static_cast<std::uint32_t>(to.data.size()));
    to.data.insert(0, head.data);
    if (std::fwrite(to.data.data(), 1, to.data.size(), stdout) != to.data.size() ||
      std::fflush(stdout) != 0)
    {{
      return 1;
    }}
  }}
  return 0;
}}
"""


def _adapter(view: GateView) -> str:
    topics = sorted({action.binding.topic for action in ACTIONS if action.binding})
    states = "\n".join(
        _STATE.format(
            topic=topics.index(state.topic), type=state.type, active=", ".join(state.active)
        )
        for state in view.states
    )
    readings = "\n".join(
        _READING.format(
            topic=sorted(READINGS).index(reading.topic),
            type=reading.type,
            numbers=", ".join(reading.read),
        )
        for reading in view.readings
    )
    tuned = ", ".join(cpp_double(each.default) for each in view.gate.tunables)
    return _ADAPTER.format(
        package=view.package,
        name=view.name,
        message_class=view.message_class,
        states=states,
        readings=readings,
        tuned=f", std::vector<double>{{{tuned}}}" if tuned else "",
    )


TOPICS = tuple(sorted({action.binding.topic for action in ACTIONS if action.binding}))
_READING_TYPES = [message_type(kind) for kind in READINGS.values()]
_STATE_TYPES = {action.binding.topic: action.binding.type for action in ACTIONS if action.binding}


def compiled(gates: Sequence[Gate], folder: Path, compiler: str, *flags: str) -> Path:
    """Compile gates, strictly, and return the program that plays traces."""
    views = [view_of(gate, f"random_{number}") for number, gate in enumerate(gates)]
    # Headers take longer than gates: few sources, each with the gates of few packages.
    ordered = sorted(range(len(gates)), key=lambda number: gates[number].type.package)
    (folder / "wire.hpp").write_text(f"#pragma once\n{wire.head()}", encoding="utf-8")
    (folder / "player.hpp").write_text(f"#pragma once\n{_PLAYER}", encoding="utf-8")
    sources = []
    for begin in range(0, len(ordered), _IN_ONE_SOURCE):
        numbers = ordered[begin : begin + _IN_ONE_SOURCE]
        text = '#include <memory>\n#include <optional>\n#include <vector>\n#include "player.hpp"\n'
        text += wire.cpp(
            STORE, [*(gates[n].type for n in numbers), *_STATE_TYPES.values(), *_READING_TYPES]
        )
        for number in numbers:
            gate = write_gate(views[number], folder)
            text += f'#include "{gate.name}"\n{_adapter(views[number])}\n'
            text += f"std::unique_ptr<Player> make_{number}();\n"
            text += f"std::unique_ptr<Player> make_{number}()\n"
            text += f"{{return std::make_unique<random_{number}::Adapter>();}}\n"
        source = folder / f"commands_{begin}.cpp"
        source.write_text(text, encoding="utf-8")
        sources.append(source)
    declarations = "\n".join(f"std::unique_ptr<Player> make_{n}();" for n in range(len(gates)))
    cases = "\n".join(f"    case {n}: return make_{n}();" for n in range(len(gates)))
    main = folder / "main.cpp"
    main.write_text(_MAIN.format(declarations=declarations, cases=cases), encoding="utf-8")
    return build([*sources, main, LOGIC], folder, compiler, *flags)


def build(sources: Sequence[Path], folder: Path, compiler: str, *flags: str) -> Path:
    """Compile each source to an object, and link them."""
    options = ("-std=c++17", *STRICT, *flags)
    includes = ("-I", str(folder), "-I", str(_INCLUDE), *message_flags())
    objects = compile_objects(compiler, options, includes, sources)
    program = folder / "program"
    _run([compiler, *flags, *map(str, objects), "-o", str(program)])
    return program


def _run(command: Sequence[str]) -> None:
    done = subprocess.run(command, capture_output=True, text=True, timeout=600, check=False)
    assert done.returncode == 0, done.stderr[:8000]


# What it plays ------------------------------------------------------------------------------------


@dataclass(frozen=True)
class Answer:
    """What a gate did about one happening.

    Attributes:
        outputs: when, what kind, and the message as :func:`tests.support.wire.encode` writes it.
        next_deadline: when something can happen by itself.
        applying: of all that can hold commands back, whether it does.
        is_done: whether it was granted, of a reset.
    """

    outputs: tuple[tuple[int, OutputKind, bytes], ...]
    next_deadline: int | None
    applying: tuple[bool, ...]
    is_done: bool


class Players:
    """A program of :func:`compiled` that runs, and ends with the block."""

    def __init__(self, program: Path, gates: Sequence[Gate]) -> None:
        """Start the program; ``gates`` are those it was made of."""
        self._gates = gates
        self._process = subprocess.Popen(
            [str(program)], stdin=subprocess.PIPE, stdout=subprocess.PIPE, stderr=subprocess.PIPE
        )

    def __enter__(self) -> Players:
        """Run."""
        return self

    def __exit__(
        self,
        kind: type[BaseException] | None,
        _error: BaseException | None,
        _trace: TracebackType | None,
    ) -> None:
        """End the program; it has to end well, which sanitizers see to."""
        _, errors = self._process.communicate(timeout=60)
        assert kind is not None or self._process.returncode == 0, errors.decode()

    def play(
        self, number: int, start_ns: int, trace: Sequence[tuple[int, Happening]]
    ) -> list[Answer]:
        """Let a trace happen to a gate; return its answers."""
        gate = self._gates[number]
        happenings = (_happening(gate, t_ns, each) for t_ns, each in trace)
        request = struct.pack("<IqI", number, start_ns, len(trace)) + b"".join(happenings)
        stdin, stdout = self._process.stdin, self._process.stdout
        assert stdin is not None
        assert stdout is not None
        stdin.write(struct.pack("<I", len(request)) + request)
        stdin.flush()
        head = stdout.read(4)
        if len(head) < 4:
            _, errors = self._process.communicate(timeout=60)
            raise AssertionError(f"the program ended: {errors.decode()}")
        (length,) = struct.unpack("<I", head)
        return list(_answers(gate, stdout.read(length), len(trace)))


def _happening(gate: Gate, t_ns: int, each: Happening) -> bytes:
    topics = sorted(READINGS) if each.call == "reading" else TOPICS
    topic = topics.index(each.topic) if each.topic else each.source
    given, trusted = each.message is not None, each.is_trusted
    call = _CALLS.index(each.call)
    head = struct.pack("<BqB??Q", call, t_ns, topic, given, trusted, each.counter)
    if each.message is None:
        return head
    if each.call == "reading":
        data = wire.encode(STORE, message_type(READINGS[each.topic]), each.message)
        return head + data if each.topic in gate.input_types else head
    kind = gate.type if each.call == "command" else _STATE_TYPES[each.topic]
    data = wire.encode(STORE, kind, each.message)
    heeded = {ACTIONS[line.action].binding for line in gate.lines if line.action is not None}
    heard = {binding.topic for binding in heeded if binding}
    return head + data if each.call == "command" or each.topic in heard else head


def _answers(gate: Gate, data: bytes, count: int) -> Iterator[Answer]:
    reader = wire.Reader(STORE, data)
    for _ in range(count):
        outputs = []
        for _ in range(reader.take("<I")):
            t_ns, what = reader.take("<q"), reader.take("<B")
            outputs.append((t_ns, _KINDS[what], reader.skip(gate.type)))
        due = reader.take("<q")
        held = len(gate.lines) + sum(line.until_reset for line in gate.lines)
        waits = gate.resume_on_zero or any(source.from_zero for source in gate.sources)
        applying = tuple(reader.take("<?") for _ in range(held + waits + len(gate.inputs)))
        is_done = reader.take("<?")
        yield Answer(tuple(outputs), None if due == _NEVER else due, applying, is_done)
    assert reader.is_at_end


def encoded(kind: InterfaceType, message: Any) -> bytes:
    """Return a message as answers hold it."""
    return wire.encode(STORE, kind, message)
