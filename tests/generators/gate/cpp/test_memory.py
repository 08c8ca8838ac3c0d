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
#include "gates_safety_cpp/{gate}_logic.hpp"

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

using Logic = gates_safety_cpp::{logic};

/// Somebody who only looks.
struct Output : Logic::Output
{{
  void publish(Logic::Published what, const Logic::Command &) override
  {{
    ++published[static_cast<std::size_t>(what)];
  }}
{stamp}
  std::array<std::size_t, 3> published{{}};
}};

int main()
{{
  Output output;
  Logic gate(0, output);
  Logic::Command command;
  {command}
  std_msgs::msg::Bool stop;
  std_msgs::msg::UInt8 mode;
  std::size_t before = 0;
  for (std::int64_t i = 1; i < 10000; ++i) {{
    const std::int64_t t = i * 7000000;
    gate.on_heartbeat(t, static_cast<std::uint64_t>(i));
    stop.data = i % 11 == 0;
    mode.data = static_cast<std::uint8_t>(i / 20 % 3);
    gate.on_state_stop(t + 1, &stop, true);
    gate.on_state_mode(t + 2, &mode, true);
    gate.on_command(t + 3, command);
    if (i % 50 == 0) {{
      gate.advance(t + 600000000);
    }}
    before = i == 100 ? taken : before;  // room for the form of the command has been found
  }}
  std::printf(
    "%zu %zu %zu %zu\\n", taken - before,
    output.published[0], output.published[1], output.published[2]);
  return 0;
}}
"""

TIME = "builtin_interfaces::msg::Time"
STAMP = f"  {TIME} stamp() override {{return {TIME}();}}"


@pytest.mark.slow
@pytest.mark.parametrize(
    ("gate", "logic", "command", "stamp"),
    [
        ("cmd_vel_gate", "CmdVelGateLogic", "command.linear.x = 0.3;", ""),
        (
            "arm_command_gate",
            "ArmCommandGateLogic",
            'command.joint_names = {"a joint with a long name", "another one, as long as it"};\n'
            "  command.points.resize(3);\n"
            "  for (auto & each : command.points) {each.velocities = {0.3, 0.7};}",
            STAMP,
        ),
    ],
    ids=["of_fixed_size", "with_texts_and_arrays"],
)
def test_logic_does_not_allocate(
    gate: str, logic: str, command: str, stamp: str, tmp_path: Path
) -> None:
    """Thousands of commands, limits, zeros and losses; strings and arrays keep their capacity."""
    write(gate_package((MODELS / "gates.deros").read_text(encoding="utf-8")), tmp_path)
    main = tmp_path / "main.cpp"
    text = COUNTER.format(gate=gate, logic=logic, command=command, stamp=stamp)
    main.write_text(text, encoding="utf-8")
    package = tmp_path / PACKAGE
    program = tmp_path / "program"
    compiler = ["c++", "-std=c++17", "-O1", *STRICT, "-I", str(package / "include")]
    source = package / "src" / f"{gate}_logic.cpp"
    files = [str(main), str(source), "-o", str(program)]
    subprocess.run([*compiler, *message_flags(), *files], check=True, timeout=300)
    done = subprocess.run([str(program)], capture_output=True, text=True, timeout=60, check=True)
    taken, *published = map(int, done.stdout.split())
    assert taken == 0
    assert all(count > 100 for count in published)  # passed, limited, zero
