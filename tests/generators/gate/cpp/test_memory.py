"""The logic of a gate does not allocate memory at run time."""

from __future__ import annotations

import subprocess
from pathlib import Path

import pytest

from deros.generators.output.writer import write
from tests.support.cpp import message_flags
from tests.support.gate_cpp import STRICT
from tests.support.gate_cpp_nodes import PACKAGE, gate_package
from tests.support.gate_nodes import MODELS
from tests.support.needs import needs

pytestmark = needs("c++")

COUNTER = """
#include <array>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <new>
#include "gates_safety_cpp/{gate}_message.hpp"
#include "gates_safety_cpp/{gate}_table.hpp"

static std::size_t taken = 0;

void * operator new(std::size_t size)
{{
  ++taken;
  if (void * memory = std::malloc(size)) {{
    return memory;
  }}
  throw std::bad_alloc();
}}
void operator delete(void * memory) noexcept {{std::free(memory);}}
void operator delete(void * memory, std::size_t) noexcept {{std::free(memory);}}

namespace gates = gates_safety_cpp;
using Gate = gates::runtime::GateOf<gates::{message}>;

/// Somebody who only looks.
struct Output : Gate::Output
{{
  void publish(gates::runtime::Published what, const Gate::Command &) override
  {{
    ++published[static_cast<std::size_t>(what)];
  }}
  builtin_interfaces::msg::Time stamp() override {{return builtin_interfaces::msg::Time();}}
  std::array<std::size_t, 5> published{{}};
}};

int main()
{{
  Output output;
  Gate gate(gates::{gate}_table::TABLE, 0, output);
  Gate::Command command;
  {command}
  std::size_t before = 0;
  for (std::int64_t i = 1; i < 10000; ++i) {{
    const std::int64_t t = i * 7000000;
    gate.on_heartbeat(t, static_cast<std::uint64_t>(i));
    gate.on_state(t + 1, {{{{"stop", i % 11 == 0}}}}, true);
    gate.on_state(t + 2, {{{mode}}}, true);
    gate.on_command(t + 3, command);
    if (i % 50 == 0) {{
      gate.advance(t + 600000000);
    }}
    before = i == 100 ? taken : before;  // room for the form of the command has been found
  }}
  std::printf(
    "%zu %zu %zu %zu\\n", taken - before,
    output.published[0], output.published[1], output.published[2] + output.published[3]);
  return 0;
}}
"""


SLOW, SLOWER = '{"slow", i / 20 % 3 == 1}', '{"slower", i / 20 % 3 == 2}'


@pytest.mark.slow
@pytest.mark.parametrize(
    ("gate", "message", "command", "mode"),
    [
        (
            "cmd_vel_gate",
            "CmdVelGateMessage",
            "command.linear.x = 0.3;",
            f"{SLOW}, {SLOWER}",
        ),
        (
            "arm_command_gate",
            "ArmCommandGateMessage",
            'command.joint_names = {"a joint with a long name", "another one, as long as it"};\n'
            "  command.points.resize(3);\n"
            "  for (auto & each : command.points) {each.velocities = {0.3, 0.7};}",
            SLOW,
        ),
    ],
    ids=["of_fixed_size", "with_texts_and_arrays"],
)
def test_logic_does_not_allocate(
    gate: str, message: str, command: str, mode: str, tmp_path: Path
) -> None:
    """Thousands of commands, limits, zeros and losses; strings and arrays keep their capacity."""
    write(gate_package((MODELS / "gates.deros").read_text(encoding="utf-8")), tmp_path)
    main = tmp_path / "main.cpp"
    text = COUNTER.format(gate=gate, message=message, command=command, mode=mode)
    main.write_text(text, encoding="utf-8")
    package = tmp_path / PACKAGE
    program = tmp_path / "program"
    compiler = ["c++", "-std=c++17", "-O1", *STRICT, "-I", str(package / "include")]
    sources = [package / "src" / f"{gate}_message.cpp", package / "src/runtime/gate_logic.cpp"]
    files = [str(main), *map(str, sources), "-o", str(program)]
    subprocess.run([*compiler, *message_flags(), *files], check=True, timeout=300)
    done = subprocess.run([str(program)], capture_output=True, text=True, timeout=60, check=True)
    taken, *published = map(int, done.stdout.split())
    assert taken == 0
    assert all(count > 100 for count in published)  # passed, limited, zero or sent
