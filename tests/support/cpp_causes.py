"""Many monitors in C with the causes that the node in C++ reports, compiled into one library."""

from __future__ import annotations

import ctypes
import subprocess
from collections.abc import Sequence
from pathlib import Path
from types import SimpleNamespace
from typing import cast

from deros.generators.runtime.cpp.interface import CppRuntime
from deros.generators.safety_node.cpp.rule_metadata import table
from deros.generators.safety_node.cpp.rule_state import held_timeouts, rule_states
from deros.generators.safety_node.cpp.whys import cause_functions, told, why_rule
from deros.generators.text.cpp import call, expression
from deros.generators.text.templates import environment
from deros.rules.engine.early import early_ones
from deros.rules.engine.engine import Engine
from deros.rules.program.ir import Program
from tests.support.c_harness import Unit
from tests.support.c_library import LIMIT, Loaded
from tests.support.c_monitors import CMonitor
from tests.support.counterexamples import Pair
from tests.support.foretold import foretold
from tests.support.monitors import START_NS, remark, timed
from tests.support.monitors import call as call_monitor
from tests.support.safety_cpp import RUNTIME

COMPILER = ("g++", "-std=c++17", "-O0", "-fPIC", "-Wall", "-Wextra", "-Werror")
_ROOM = 1 << 20
_TOLD = """
extern "C" std::size_t tell_{prefix}(const {prefix}_monitor * m, char * out, std::size_t room)
{{
  const auto state = told_{prefix}::monitor_snapshot(*m);
  std::string text;
  for (const auto & rule : state.rules) {{
    text += rule.name + deros_runtime_cpp::to_text(rule.verdict);
    for (const auto & cause : rule.causes) {{
      text += '\\t' + cause;
    }}
    text += '\\n';
  }}
  for (const auto & [behaviour, causes] : state.causes) {{
    text += std::to_string(behaviour) + '\\t' + causes + '\\n';
  }}
  deros_runtime_cpp::LookAhead ahead(state.rules, told_{prefix}::monitor_copies(*m));
  while (ahead.step()) {{
  }}
  for (std::size_t i = 0; i < state.rules.size(); ++i) {{
    for (const auto & next : ahead.found()[i]) {{
      text += std::to_string(i) + ' ' + next.condition + ": " +
        deros_runtime_cpp::to_text(next.verdict) + " at " + std::to_string(next.at) + '\\n';
    }}
  }}
  return text.copy(out, room);
}}
"""


_WORDS = {None: "unknown", True: "true", False: "false"}


class Told(Loaded):
    """Monitors that report why their rules are true and their behaviours hold."""

    def __init__(self, units: Sequence[Unit], folder: Path) -> None:
        """Compile the monitors and the reports of their causes in a folder of their own."""
        folder.mkdir(parents=True, exist_ok=True)
        for each in units:
            for name, text in each.texts.items():
                (folder / name).write_text(text, encoding="utf-8")
        (folder / "told.cpp").write_text(_source(units), encoding="utf-8")
        command = [*COMPILER, "-I", ".", f"-I{RUNTIME / 'include'}", "-c", "told.cpp"]
        done = subprocess.run(
            command, cwd=folder, capture_output=True, text=True, timeout=LIMIT, check=False
        )
        assert done.returncode == 0, done.stderr
        super().__init__(units, folder, "-O0", "told.o", "-lstdc++")

    def tell(self, number: int) -> str:
        """Return the causes of the monitor that was started last."""
        function = self._library[f"tell_{self.units[number].prefix}"]
        function.restype = ctypes.c_size_t
        out = ctypes.create_string_buffer(_ROOM)
        count = function(self._monitor, out, ctypes.c_size_t(_ROOM))
        return out.raw[:count].decode()


def compare(library: Told, number: int, pair: Pair) -> int:
    """Drive the reference and a monitor with the same calls; they must report the same causes.

    Returns:
        The number of causes reported.

    Raises:
        AssertionError: they do not.
    """
    start = pair.start
    program = library.units[number].program
    engine = Engine(program, START_NS, start.grace_ns, start.latched, dict(start.constants))
    monitor = CMonitor(library, number, START_NS, start)
    count = 0
    for t_ns, step in timed(pair.steps):
        remark(f"at {t_ns} {step}")
        call_monitor(engine, t_ns, step)
        call_monitor(cast("Engine", monitor), t_ns, step)
        expected = _told(engine, library.units[number]) + _foretold(engine, program)
        assert library.tell(number) == expected
        count += expected.count("\t")
    return count


def _told(engine: Engine, unit: Unit) -> str:
    state = engine.explain()
    lines = ["\t".join((f"{rule.name}{_WORDS[rule.value]}", *rule.causes)) for rule in state.rules]
    names = [name for name, _ in unit.view.behaviour_names]
    for name, causes in state.causes.items():
        lines.append(f"{names.index(name)}\t{'; '.join(causes)}")
    return "".join(f"{line}\n" for line in lines)


def _foretold(engine: Engine, rules: Program) -> str:
    found = foretold(engine, rules)
    return "".join(
        f"{place} {case}: {_WORDS[then.value]} at {then.at}\n"
        for place in sorted(found)
        for case, then in found[place].items()
    )


def _source(units: Sequence[Unit]) -> str:
    parts = [
        f'#include "{RUNTIME}/src/report_types.cpp"',
        f'#include "{RUNTIME}/src/look_ahead.cpp"',
        f'#include "{RUNTIME}/src/text.cpp"',
        "#include <cmath>",
        "#include <limits>",
    ]
    for unit in units:
        parts += [f'#include "{unit.prefix}_monitor.h"', f"namespace told_{unit.prefix} {{"]
        parts += ["namespace runtime = deros_runtime_cpp;", _told_in_cpp(unit), "}"]
        parts.append(_TOLD.format(prefix=unit.prefix))
    return "\n".join(parts)


def _told_in_cpp(unit: Unit) -> str:
    """Return what the node has in its ``_rule_metadata.cpp``, without the tables."""
    layout, program = unit.view.layout, unit.program
    early = early_ones(unit.view.program)
    rules = zip(program.rules, rule_states(program, layout), strict=True)
    view = SimpleNamespace(
        package="told",
        stem="told",
        header="",
        rules="",
        prefix=unit.prefix,
        macro=layout.macro,
        rule_metadata=["0"],
        held=held_timeouts(program, layout),
        cause_functions=list(cause_functions(unit.view.program, layout)),
        rule_states=[
            (state, layout.verdicts[rule.index], why_rule(layout, rule.index))
            for rule, state in rules
        ],
        conditions=[
            (
                str(number),
                told(unit.view.program, layout, number),
                told(unit.view.program, layout, early[number]) if number in early else None,
            )
            for number, _ in enumerate(unit.view.behaviour_names)
        ],
    )
    template = environment("deros.generators.safety_node.cpp").get_template("rule_metadata.cpp.j2")
    text: str = template.render(
        safety=view,
        runtime=CppRuntime("told"),
        standard=[],
        call=call,
        table=table,
        expression=expression,
    )
    return text[text.index("/// Return why") : text.index("}  // namespace told")]
