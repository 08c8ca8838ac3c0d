"""Names of messages and rules never hide a name used by the emitted C code."""

from __future__ import annotations

import re
import subprocess
from pathlib import Path

import pytest

from deros.interfaces.store import InterfaceStore
from deros.metamodels.load import Repository
from deros.models.rules import Rules
from deros.rules.compiler.build import build
from tests.support import c_proof
from tests.support.c_everything import NODE, RULES, SYSTEM, texts_of
from tests.support.needs import needs

STRICT = ["-std=c99", "-Wall", "-Wextra", "-Wpedantic", "-Wconversion", "-Wshadow", "-Werror"]
KEYWORDS = {"if", "pass", "for", "while", "switch", "return", "sizeof"}
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
    built = build(model, InterfaceStore([folder]))
    assert built.program is not None, [diagnostic.message for diagnostic in built.diagnostics][:3]
    return c_proof.write(built.program, folder / "c")


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
