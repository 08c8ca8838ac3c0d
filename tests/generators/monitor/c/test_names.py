"""Names of messages and rules never hide a name used by the emitted C code."""

from __future__ import annotations

import re
import subprocess
import tempfile
from pathlib import Path

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from deros.generators.api.protocol import GenerationError
from deros.generators.monitor.c.render import render_monitor
from deros.interfaces.store import InterfaceStore
from deros.metamodels.load import Repository
from deros.models.rules import Rules
from deros.rules.compiler.build import build
from tests.support import c_proof
from tests.support.c_everything import NODE, RULES, SYSTEM, built, texts_of
from tests.support.needs import needs

STRICT = ["-std=c99", "-Wall", "-Wextra", "-Wpedantic", "-Wconversion", "-Wshadow", "-Werror"]
KEYWORDS = {"if", "pass", "for", "while", "switch", "return", "sizeof"}
ENTITY = """\
use "robot.system" import Robot
input v = topic /battery.voltage timeout 1 sec
entity e { r: v < 11; }
"""
ARRAYS = """\
float64 x_count
float64[] x
float64 x_count_2
string y
float64 y_length
int32[] z
float64 z_given
geometry_msgs/Quaternion o
float64 o_last_rate
float64 new_o_total
"""
"""Fields with the names of generated parameters, declared before and after their arrays."""
_LOCAL = re.compile(r"^ +(?:const )?(?:bool|double|int64_t|uint32_t|size_t) (\w+) =", re.MULTILINE)
_FIELD = re.compile(r"[a-z](?:_?[a-z0-9])*")


def _own_names() -> list[str]:
    """Return the names used by a monitor and its contracts that are valid field names."""
    texts = texts_of("everything").values()
    called = {name for text in texts for name in re.findall(r"(\w+)(?:\{\w+\})?\(", text)}
    called |= {name for text in texts for name in _LOCAL.findall(text)}
    called |= {re.sub(r"_(?:scan|imu)$", "_hostile", name) for name in called}
    called -= {*KEYWORDS, *re.findall(r"(\w+)$", ARRAYS, re.MULTILINE)}
    return sorted(name for name in called if _FIELD.fullmatch(name))


def _rules(names: list[str]) -> str:
    """Return rules that read a field of each name, along with every construct."""
    fields = [*names, "x_count", "x_count_2", "y_length", "z_given", "z[1]"]
    fields += ["o_last_rate", "new_o_total"]
    inputs = "".join(f"input x{i} = topic /hostile.{name}\n" for i, name in enumerate(fields))
    inputs += "input x = topic /hostile.x\ninput y = topic /hostile.y\n"
    inputs += "input o = topic /hostile.o\n"
    tests = " or ".join(f"x{i} > 0.5" for i in range(len(fields)))
    rules = f'  r: {tests} or x.max() > 0.5 or y = "on" or o.yaw().rate() > 1;\n'
    return f"{RULES}\n{inputs}entity hostile {{\n{rules}}}\nif hostile.r then {{ stop; }};\n"


@pytest.fixture(scope="module")
def source(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Return the monitor of these rules, with its contracts."""
    folder = tmp_path_factory.mktemp("hostile")
    names = _own_names()
    definition = folder / "hostile_msgs" / "msg" / "Hostile.msg"
    definition.parent.mkdir(parents=True)
    definition.write_text("".join(f"float64 {name}\n" for name in names) + ARRAYS, encoding="utf-8")
    (folder / "robot.rnd").write_text(
        NODE + "  topic /hostile : hostile_msgs.Hostile\n", encoding="utf-8"
    )
    system = SYSTEM.replace("topics\n", "topics\n  topic /hostile\n")
    system = system.replace("wirings\n", "wirings\n    connect /hostile to /hostile\n")
    (folder / "robot.system").write_text(system, encoding="utf-8")
    repository = Repository()
    model = repository.load_text(folder / "everything.deros", _rules(names)).model
    assert isinstance(model, Rules), repository.diagnostics
    result = build(model, InterfaceStore([folder]))
    assert result.program is not None, [each.message for each in result.diagnostics][:3]
    return c_proof.write(result.program, folder / "c")


@pytest.mark.slow
@needs("gcc")
def test_fields_may_have_names_of_monitor_functions(source: Path) -> None:
    """Each becomes a parameter of a function that calls functions of the monitor."""
    command = ["gcc", *STRICT, "-c", source.name, "-o", "monitor.o"]
    result = subprocess.run(
        command, cwd=source.parent, capture_output=True, text=True, timeout=120, check=False
    )
    assert result.returncode == 0, result.stderr[:4000]


@needs("frama-c", "why3", "z3", "cvc4")
@pytest.mark.slow
def test_contracts_refer_to_monitor_functions(source: Path) -> None:
    """A function called in a contract is not hidden by a parameter."""
    assert c_proof.unreadable(source) == ""


@pytest.mark.parametrize(
    ("rules", "expected"),
    [
        (
            "action stop; action Stop; if e.r then { stop; Stop; };",
            "action 'Stop' and action 'stop' both become 'NAMED_ACTION_STOP' in the monitor in C",
        ),
        (
            'action Log_state; if e.r then { Log_state; log_state("a"); };',
            "action 'log_state' and action 'Log_state' both become 'NAMED_ACTION_LOG_STATE' in the "
            "monitor in C",
        ),
        (
            "behaviour a: if e.r then {}; behaviour A: if e.r then {};",
            "behaviour 'A' and behaviour 'a' both become 'NAMED_BEHAVIOUR_A' in the monitor in C",
        ),
        (
            "behaviour none: if e.r then {};",
            "behaviour 'none' and the enumerator of no behaviour both become "
            "'NAMED_BEHAVIOUR_NONE' in the monitor in C",
        ),
    ],
)
def test_names_that_are_one_in_capitals_are_refused(rules: str, expected: str) -> None:
    """Enumerators are in capitals, and one stands for no behaviour."""
    with pytest.raises(GenerationError) as raised:
        render_monitor(built(f"{ENTITY}\n{rules}", "named"))
    assert [each.message for each in raised.value.diagnostics] == [expected]
    assert raised.value.diagnostics[0].code.name == "DRS401"


_WORDS = st.sampled_from(
    [
        *("a", "A", "a_b", "aB", "m", "t", "due", "known", "since_2", "early", "round_2"),
        *("judge", "by", "behave", "expire", "forget", "settle", "observe", "latch", "enable"),
        *("start", "reset", "constants", "default_constants", "none", "NONE", "stop", "STOP"),
    ]
)


@st.composite
def _named_rules(draw: st.DrawFn) -> tuple[str, str]:
    """Return a name and rules in which anything has the name of anything else."""

    def names(most: int) -> list[str]:
        return draw(st.lists(_WORDS, min_size=1, max_size=most, unique=True))

    values = draw(st.lists(_WORDS, min_size=2, max_size=5, unique=True))
    inputs, constants = values[1::2], values[::2]
    text = 'use "robot.system" import Robot\n'
    text += "".join(f"input {each} = topic /battery.voltage timeout 1 sec\n" for each in inputs)
    text += "".join(f"const {each} = 3 V tunable in [1, 5] V\n" for each in constants)
    rules: list[str] = []
    for entity in names(2):
        text += f"entity {entity} {{\n"
        for rule in names(3):
            text += f"  {rule}: {draw(st.sampled_from(inputs))} > "
            text += f"{draw(st.sampled_from(constants))} for 1 sec;\n"
            rules.append(f"{entity}.{rule}")
        text += "}\n"
    actions = names(3)
    text += "".join(f"action {each} latched;\n" for each in actions)
    for number, each in enumerate(names(3)):
        text += f"{draw(st.sampled_from(['', 'optional ']))}behaviour {each}: "
        text += f"if {rules[number % len(rules)]} then {{ {draw(st.sampled_from(actions))}; }};\n"
    return draw(_WORDS), text


@pytest.mark.slow(seconds=20)
@needs("gcc")
@settings(max_examples=100, deadline=None)
@given(_named_rules())
def test_names_that_are_accepted_are_different(named: tuple[str, str]) -> None:
    """Whatever a model calls its parts, the monitor compiles or is refused."""
    name, text = named
    program = built(text, name)
    try:
        files = render_monitor(program)
    except GenerationError:
        return
    with tempfile.TemporaryDirectory() as folder:
        for path, content in files.items():
            (Path(folder) / path).write_text(content, encoding="utf-8")
        source = next(path for path in files if path.endswith(".c"))
        command = ["gcc", *STRICT, "-fsyntax-only", source]
        done = subprocess.run(command, cwd=folder, capture_output=True, text=True, check=False)
    assert done.returncode == 0, text + done.stderr[:2000]
