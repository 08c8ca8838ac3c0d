"""The text of the generated monitor: readable, deterministic, lint-clean, with few imports."""

from __future__ import annotations

import ast
import functools
import keyword
import math
import subprocess
import sys
from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path
from typing import Any

import pytest

from deros.diagnostics import SourceFile, Span
from deros.generators.api.protocol import File, Owner
from deros.generators.monitor.python.conditions import scaled
from deros.generators.monitor.python.interface import (
    EXPLANATION,
    MONITOR,
    monitor_view,
    render_monitor,
)
from deros.generators.monitor.python.run import GeneratedMonitor
from deros.generators.monitor.python.view import laid_out
from deros.interfaces.types import FieldType, InterfaceType
from deros.rules.engine.evaluate import evaluate_value
from deros.rules.engine.state import State
from deros.rules.program import ir
from tests.support import timelines
from tests.support.c_everything import built
from tests.support.c_snippets import SMALLEST_RULES
from tests.support.golden import Golden
from tests.support.profiles import slow
from tests.support.python_snippets import RULES, shapes, snippets, texts_of
from tests.support.timelines import Timeline

EVERYTHING = """use "robot.system" import Robot
action stop publishes true on /stop : std_msgs.Bool reset_by ok;
action motor_stop publishes true on /motor_stop : std_msgs.Bool latched;
action ok;
action beep(times);
const max_speed = 0.5 m/s
input speed = topic /odom.twist.twist.linear.x timeout 0.5 sec
input attitude = topic /imu.orientation timeout 0.1 sec
input turn = topic /imu.angular_velocity
input mode = topic /mode.data timeout 1 sec
input enabled = topic /flag.data
input scan = topic /scan timeout 2 sec
entity drive {
  // the comment stays with the rule
  too_fast: speed > max_speed for 2 sec;
  jerky: speed.rate() > 2 and not enabled;
  quiet: speed.missing() or scan.age() > 1 sec;
}
entity body {
  tilted: attitude.roll() not in [-10 deg, 10 deg] or
          attitude.pitch() not in [-10 deg, 10 deg);
  turning: turn.norm() >= 90 deg/s;
  near: scan.nearest(-30 deg, 30 deg) < 0.4 or scan.blind(-30 deg, 30 deg) > 0.2;
}
entity controller { manual: mode = 0; auto: mode != 0 and enabled; }
entity doubt {
  blind: attitude.tilt().unknown() or speed.unknown() or mode = 3;
  failsafe hidden: (attitude.tilt() > 20 deg and speed in [-max_speed, max_speed]) for 0.2 sec;
}
if drive.too_fast and controller.auto then { stop; log_state("too fast: don't"); };
behaviour tilt: if body.tilted for 0.4 sec then {
  motor_stop;
  if not controller.manual for 1 sec then { beep(3); };
  stop;
};
if body.near or body.turning or drive.quiet or drive.jerky then { stop; };
if controller.manual then { ok; };
if doubt.blind or doubt.hidden then { stop; };
entity summary {
  failsafe pressing: (danger for 0.5 sec) and not controller.manual and mode = 2;
  danger: drive.too_fast or doubt.hidden;
}
if summary.pressing then { motor_stop; };
"""


def _lint(folder: Path) -> str:
    """Return the output of flake8, with ament's settings, and pydocstyle for a folder."""
    settings = [
        "--isolated",
        "--extend-ignore=B902,C816,D100,D101,D102,D103,D104,D105,D106,D107,D203,D212,D404,I202",
        "--import-order-style=google",
        "--max-line-length=99",
    ]
    ignored = "D100,D101,D102,D103,D104,D105,D106,D107,D203,D212,D404"
    commands = [["flake8", *settings, "."], ["pydocstyle", f"--ignore={ignored}", "."]]
    results = [
        subprocess.run(
            [sys.executable, "-m", *command],
            cwd=folder,
            capture_output=True,
            text=True,
            check=False,
        )
        for command in commands
    ]
    return "".join(result.stdout + result.stderr for result in results)


@pytest.mark.essential
def test_snippets_match_golden(golden: Golden) -> None:
    """The text of the smallest monitor, and what each construct adds to it, match the reviewed."""
    files = {f"{name}.py": File(text, Owner.USER) for name, text in snippets().items()}
    golden.check("monitor_python", files)


@functools.cache
def shapes_shown() -> set[tuple[str, str]]:
    """Return the shapes of all that is shown."""
    return set().union(*(shapes(texts_of(rules)) for rules in (SMALLEST_RULES, *RULES.values())))


@pytest.mark.essential
def test_snippets_show_every_kind_of_code() -> None:
    """Whoever adds a construct, a method or a statement to the text of a monitor adds it here."""
    texts = render_monitor(timelines.program(EVERYTHING, "everything"))
    assert shapes(texts) - shapes_shown() == set(), "show them in tests/support/python_snippets.py"


@pytest.mark.parametrize(
    "added",
    [
        "        self._due = self._drive_jerky_due",
        "        self._restart(t)",
        "        while t > self._due:\n            t = t",
        "        t >= self._due",
        "\n    def flush(self) -> None:\n        self._now = 0",
    ],
)
def test_code_that_is_not_shown_is_found(added: str) -> None:
    """Each is a statement that methods of that kind do not have in any snippet."""
    texts = render_monitor(timelines.program(EVERYTHING, "everything"))
    begins = "        done = True\n"
    assert texts[MONITOR].count(begins) == 1
    changed = {**texts, MONITOR: texts[MONITOR].replace(begins, f"{begins}{added}\n")}
    assert shapes(changed) - shapes_shown() != set()


@pytest.mark.parametrize("cases", [timelines.GIVEN, slow(timelines.ALL)], ids=["given", "all"])
def test_monitors_pass_the_linters(cases: Sequence[Timeline], tmp_path: Path) -> None:
    """flake8 and pep257 with ament's settings accept monitors of any rules."""
    programs = [case.program() for case in cases]
    programs.append(timelines.program(EVERYTHING, "everything"))
    for number, program in enumerate([*programs, _awkward()]):
        package = tmp_path / f"monitor_{number}"
        package.mkdir()
        for name, text in render_monitor(program).items():
            (package / name).write_text(text)
    assert _lint(tmp_path) == ""


def test_linter_settings_are_in_force(tmp_path: Path) -> None:
    """An unused import and a long line are detected."""
    (tmp_path / "bad.py").write_text(f'import os\n\ntext = "{"x" * 100}"\n')
    messages = _lint(tmp_path)
    assert all(code in messages for code in ("F401", "E501", "Q000"))


def test_rendering_is_deterministic() -> None:
    """Repeated renderings of one program are equal."""
    first, *others = (render_monitor(timelines.program(EVERYTHING)) for _ in range(3))
    assert others == [first, first]


def _imported(text: str) -> set[str | None]:
    tree = ast.parse(text)
    return {
        name
        for node in ast.walk(tree)
        if isinstance(node, ast.Import | ast.ImportFrom)
        for name in (
            [each.name for each in node.names] if isinstance(node, ast.Import) else [node.module]
        )
    }


def test_only_the_standard_library_is_imported() -> None:
    """Neither ROS nor deros is imported; numpy is if arrays are read."""
    texts = render_monitor(timelines.program(EVERYTHING))
    alone = {"collections.abc", "copy", "enum", "math", "typing"}
    assert _imported(texts[MONITOR]) == {*alone, "functools", "numpy"}
    assert _imported(texts[EXPLANATION]) == {"collections.abc", "ctypes", "monitor", "typing"}
    lines = [line for line in EVERYTHING.splitlines(keepends=True) if "scan" not in line]
    small = "".join(lines).replace("body.near or", "").replace("drive.quiet or", "")
    texts = render_monitor(timelines.program(small))
    assert _imported(texts[MONITOR]) == alone
    assert _imported(texts[EXPLANATION]) == {"collections.abc", "monitor", "typing"}


def test_each_rule_is_quoted_above_its_code() -> None:
    """The comment has name, line and text of the rule."""
    text = render_monitor(timelines.program(EVERYTHING, "everything"))[MONITOR]
    assert "# Rule drive.too_fast (everything.deros:15)\n" in text
    assert "#   too_fast: speed > max_speed for 2 sec" in text
    assert " for\n        #     0.2 sec;\n" in text
    assert "# Behaviour tilt (everything.deros:31)\n" in text
    assert str(timelines.DIRECTORY) not in text


def _awkward() -> ir.Program:
    """Return a program with names that are keywords, builtins, duplicates, or very long."""
    source = SourceFile("/some/where/awkward.deros", "x" * 300)
    span = Span(source, 0, 300)
    kind = InterfaceType("std_msgs", "msg", "Float64")
    fields = ("from", "self", "t", "due", "max", "math", "class", "NAN")
    names = ("in", "in_", "due", "emit", "t", "now", "rate_per_second", "Monitor")
    topics = ("/a/b", "/a_b", "~/a/b", "/class", "/class", "/t", "/now", "/act")
    leaves = tuple(ir.Leaf(n, n, (field,), FieldType("float64")) for n, field in enumerate(fields))
    inputs = tuple(
        ir.Input(n, name, topics[n], kind, (), (n,), 5, span) for n, name in enumerate(names)
    )
    conditions: list[ir.Condition] = [
        ir.Compare(ir.Apply("rate", (ir.Read(n),), n, n), ">", ir.Read(n)) for n in range(8)
    ]
    long = ir.Or((*conditions, ir.And((*conditions, ir.Or(tuple(conditions[:4]))))))
    rules = (
        ir.Rule(0, "emit", "t", long, span),
        ir.Rule(1, "in", "", ir.Missing(0), span),
        ir.Rule(2, "a" * 60, "b" * 60, ir.For(0, ir.Not(long), 5, span), span),
    )
    texts = ('it\'s "so" ' * 20, "\n\t\\", "ünï")
    body = tuple(ir.Trigger(0, (text,), span) for text in texts)
    condition = ir.And((ir.RuleRef(0), ir.Not(ir.RuleRef(2)), ir.RuleRef(1)))
    behaviours = (
        ir.Behaviour(0, "emit_t", condition, body, None, span),
        ir.Behaviour(1, "evaluate", ir.For(1, condition, 3, span), body, None, span),
    )
    actions = (ir.Action(0, "log_state", (), None, 0, False, (0, 1), span),)
    return ir.Program('odd """ name', leaves, inputs, rules, behaviours, actions)


def test_names_do_not_collide() -> None:
    """Keywords, builtins and equal names get unique identifiers, and the monitor runs."""
    program = _awkward()
    view, (_, layout) = monitor_view(program), laid_out(program)
    tables = (layout.verdicts, layout.since, layout.holds, layout.active, layout.ran, layout.dues)
    attributes = [name for table in tables for name in table.values()]
    attributes += [slot.name for slot in layout.values.values()]
    assert len(set(attributes)) == len(attributes)
    methods = [each.method for each in view.handlers]
    assert methods == ["on_a_b", "on_a_b_2", "on_a_b_3", "on_class", "on_t", "on_now", "on_act"]
    for handler in view.handlers:
        parameters = [parameter.name for parameter in handler.parameters]
        assert len({"self", "t", *parameters}) == len(parameters) + 2
        assert not any(keyword.iskeyword(name) for name in parameters)
    monitor = GeneratedMonitor(program)
    for n, each in enumerate(program.inputs):
        monitor.message(n, each.topic, dict.fromkeys(range(len(program.leaves)), 1.0))
    monitor.advance(100)


def test_latched_action_that_nothing_triggers_is_reset() -> None:
    """It may be active all the same: a state file tells so, from rules that did trigger it."""
    rules = f'use "robot.system" import Robot\n{RULES["latched_action"]}'
    whole = built(rules, "latched")
    program = replace(whole, behaviours=(), actions=(replace(whole.actions[0], triggered_by=()),))
    monitor = GeneratedMonitor(program, latched=["stop"])
    assert monitor.reset(5)
    assert [(each.kind, each.action) for each in monitor.events] == [("reset", "stop")]


@pytest.mark.parametrize("present", [1.0, None])
def test_missing_element_is_passed_as_nan(present: float | None) -> None:
    """If the path of a parameter has an index, NaN means that the element does not exist."""
    case = next(each for each in timelines.ALL if each.name == "element_of_an_array")
    program = case.program()
    (handler,) = monitor_view(program).handlers
    assert [(parameter.name, parameter.path) for parameter in handler.parameters] == [
        ("ranges_2", ("ranges", 2))
    ]
    monitor = GeneratedMonitor(program)
    monitor.message(1, "/scan", {0: present})
    assert len(monitor.events) == (present is not None)


@pytest.mark.parametrize("function", ["count", "min"])
def test_missing_array_is_passed_as_nan(function: str) -> None:
    """An array in a missing element makes the input unknown, too."""
    rules = f"""use "robot.system" import Robot
action stop publishes true on /stop : std_msgs.Bool latched;
input ranges = topic /scan.ranges timeout 1 sec
entity e {{ some: ranges.{function}() > 0; none: ranges.missing(); }}
if e.some or e.none then {{ stop; }};
"""
    program = timelines.program(rules)
    leaves = (replace(program.leaves[0], path=("scans", 0, "ranges")),)
    monitor = GeneratedMonitor(replace(program, leaves=leaves))
    monitor.message(1, "/scan", {0: None})
    assert not monitor.events
    monitor.advance(1_000_000_000)
    assert [event.action for event in monitor.events] == ["stop"]


REPEATED = """use "robot.system" import Robot
action stop;
input v = topic /speed.data timeout 1 sec
input on = topic /flag.data
entity e { fast: v > 0.5 for 2 sec; on: on; }
if e.fast or e.on then { stop; };
"""


def test_repeated_message_is_not_evaluated() -> None:
    """Without new values no rule is evaluated, but the timeout restarts."""
    text = render_monitor(timelines.program(REPEATED))[MONITOR]
    module: dict[str, Any] = {}
    exec(text.replace("Evaluate the rules on", 'Evaluate"""; JUDGED.append(t); """'), module)
    judged = module["JUDGED"] = []
    monitor = module["Monitor"](0, [].append)
    for t, value in enumerate((0.4, 0.4, 0.4, 0.6, 0.6, math.nan, math.nan, 0.6)):
        monitor.on_speed(t, value)
    assert judged == [0, 3, 5, 6, 7]
    assert monitor.next_deadline == 10**9
    monitor.advance(10**9)
    assert monitor.next_deadline == 10**9 + 7


def _reaches_into_the_monitor(texts: dict[str, str]) -> set[str]:
    """Return what an explanation assigns, overrides or calls of the monitor that it extends."""
    classes = [ast.parse(text).body[-1] for text in texts.values()]
    assert all(isinstance(each, ast.ClassDef) for each in classes)
    methods = [{e.name for e in ast.walk(c) if isinstance(e, ast.FunctionDef)} for c in classes]
    own = [each for each in ast.walk(classes[1]) if isinstance(each, ast.Attribute)]
    assigned = {each.attr for each in own if not isinstance(each.ctx, ast.Load)}
    called = {
        each.func.attr
        for each in ast.walk(classes[1])
        if isinstance(each, ast.Call) and isinstance(each.func, ast.Attribute)
    }
    return assigned | methods[0] & methods[1] | called & methods[0]


def test_explanation_changes_nothing() -> None:
    """It cannot change what the monitor decides: it only reads."""
    texts = render_monitor(timelines.program(EVERYTHING))
    assert _reaches_into_the_monitor(texts) == set()


@pytest.mark.parametrize(
    ("slip", "found"),
    [
        ("self._now = 0", "_now"),
        ("self._due += 1", "_due"),
        ("self.advance(self._now)", "advance"),
        ("def reset(self, t):\n            return True", "reset"),
    ],
)
def test_explanation_that_changes_something_is_found(slip: str, found: str) -> None:
    """Each is a way to change what the monitor decides."""
    texts = render_monitor(timelines.program(EVERYTHING))
    begins = "        causes = {}\n"
    assert texts[EXPLANATION].count(begins) == 1
    texts[EXPLANATION] = texts[EXPLANATION].replace(begins, f"{begins}        {slip}\n")
    assert _reaches_into_the_monitor(texts) == {found}


def test_rules_of_behaviours_are_listed() -> None:
    """A monitor lists the rules in the condition of each behaviour."""
    module: dict[str, Any] = {}
    exec(render_monitor(timelines.program(EVERYTHING))[MONITOR], module)
    assert module["Monitor"].rules_of is module["RULES_OF"]
    assert module["RULES_OF"]["behaviour_1"] == ("drive.too_fast", "controller.auto")
    assert module["RULES_OF"]["behaviour_3"] == ("controller.manual",)


@pytest.mark.parametrize("offset", [0.0, 3.0])
@pytest.mark.parametrize("factor", [2.0, -2.0])
@pytest.mark.parametrize("value", [0.0, -0.0])
def test_printed_conversion_gives_zero_the_same_sign(
    value: float, factor: float, offset: float
) -> None:
    """A conversion without an offset does not add one: -0.0 + 0.0 is 0.0."""
    scale = ir.Scale(ir.Const(value), factor, offset)
    state = State(ir.Program("empty", (), (), (), (), ()), 0, 0)
    expected = evaluate_value(scale, state)
    assert isinstance(expected, float)
    printed = eval(scaled(repr(value), scale))
    assert (printed, math.copysign(1.0, printed)) == (expected, math.copysign(1.0, expected))
