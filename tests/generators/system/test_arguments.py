"""Whatever the arguments are, every way of starting a system starts what the model says."""

from __future__ import annotations

import functools
import itertools
import random
import sys
from collections.abc import Mapping
from pathlib import Path
from types import ModuleType, SimpleNamespace
from typing import Any

import pytest
from hypothesis import HealthCheck, assume, given, settings
from hypothesis import strategies as st

from deros.generators.api.protocol import GenerationError
from deros.generators.builtin import rossystem_launch, rossystem_script
from deros.generators.output.writer import write
from deros.generators.system.script.generate import (
    declared_to_run,
    system_to_run,
    table,
)
from deros.generators.system.script.standalone.arguments import given as given_values
from deros.generators.system.script.standalone.node import Node
from deros.generators.system.view import system_view
from deros.models.common import Scalar
from deros.models.system import System
from deros.names.graph_names import resolve_name
from deros.systems.arguments.resolve import resolve
from tests.support import launch
from tests.support.argument_systems import VALUES, load, systems
from tests.support.arguments import text_of
from tests.support.lint import assert_lint_clean
from tests.support.systems import CONTEXT, load_text

WHOLE = """system Whole "All that arguments can be used for"
argument robot : string = "robot" not_empty "Prefix of all names"
argument topic : string = "scan" "Where the scan is"
argument speed : double = 0.5 [m/s] in [0, 2)
argument count : int = 2 in [1, 4]
argument slam : bool = true "Make a map"
argument mode : string = "auto" one_of ["auto", "manual", "1"]
argument free : string = "it's"
imports import "*.rnd"
topics
  topic "/${robot}/scan"
  topic "/${robot}/other" when not slam
subsystem front namespace $robot {
  node eye : eye "Looks ahead" when slam and mode != "manual"
  parameters
    param frame = "${robot}_${count}"
    param speed = -$speed * (2 + $count) / 4
    param n = $count - 1
    param fast = $slam
    param names = ["${robot}/a", "b", $mode]
    param rates = [$count, 1.5]
  wirings
    connect scan to $topic when slam
    connect scan to "/${robot}/other" when not slam
}
node chosen : eye
  parameters
    param frame = if slam and mode != "1" then "${robot}_map"
      else if free = "1" then $free else "it's"
    param speed = 2 * (if count > 2 then $speed else -$count) - 1
    param n = if not slam then $count else 0
    param fast = if mode in ["auto", "1"] then $slam else true
  wirings
    connect scan to "/${robot}/scan"
node second : eye when count in [1, 3] or speed >= 1.0
  or (free = "1" and mode = "1") or not (free = mode)
wirings
  connect scan to "/${robot}/scan" when mode in ["auto", "manual"]
remappings
  remap "/${robot}/tf" to tf when slam
  remap /tf_static to "${robot}/tf_static"
"""

EYE = """node eye : eyes
parameters
  name frame : string = "f"
  name speed : double = 0.0
  name n : integer = 0
  name fast : bool = false
  name names : string[] = ["x"]
  name rates : double[] = [0.0]
publishes topic scan : sensor_msgs.LaserScan
"""


def as_modelled(
    system: System, values: Mapping[str, Scalar], root: str = "/"
) -> list[tuple[Any, ...]]:
    """Return what the model starts in a namespace for values of its arguments."""
    return [
        (node.full_name, node.executable, plain(node.parameters), targets(node))
        for node in table(system_view(resolve(system, values), root=root))
        if isinstance(node, Node)
    ]


def plain(parameters: Mapping[str, Any]) -> dict[str, Any]:
    """Return parameters with lists for tuples, and the types of numbers beside them."""
    listed = {n: list(v) if isinstance(v, tuple) else v for n, v in parameters.items()}
    return {name: (value, repr(value)) for name, value in listed.items()}


def targets(node: Any) -> dict[str, str]:
    """Return the graph names that a node is connected to, as ROS 2 resolves them.

    Of two for one full name, the first counts. A remapping to the name that the node has anyway
    says nothing.
    """
    found: dict[str, str] = {}
    for name, target in node.remappings.items():
        full = resolve_name(name.rpartition("://")[2], node.namespace, node.name)
        found.setdefault(full, resolve_name(target, node.namespace, node.name))
    return {name: target for name, target in found.items() if name != target}


def script_of(system: System) -> ModuleType:
    """Return the generated script as a module."""
    file, *_ = rossystem_script(system, CONTEXT).values()  # copies of parameter files follow
    module = ModuleType("generated_script")
    sys.modules["generated_script"] = module  # where its dataclasses look for their types
    exec(compile(file.text, "script.py", "exec"), vars(module))
    return module


def from_script(script: ModuleType, words: list[str]) -> list[tuple[Any, ...]]:
    """Return what a script starts when it is called with ``words``."""
    values: SimpleNamespace = script.given(script.ARGUMENTS, words)
    return [
        (node.full_name, node.executable, plain(node.parameters), targets(node))
        for node in script.nodes(values)
        if hasattr(node, "executable")
    ]


def from_launch(
    text: str, given: Mapping[str, str], folder: str = "", root: str = "/"
) -> list[tuple[Any, ...]]:
    """Return what a launch file starts for these arguments where it is included in a namespace."""
    found = []
    started = launch.started(text, given, folder, root)
    for full_name, executable, parameters, remappings in started:
        namespace, _, name = full_name.rpartition("/")
        node = SimpleNamespace(namespace=namespace or "/", name=name, remappings=remappings)
        found.append((full_name, executable, plain(parameters), targets(node)))
    return found


def launch_file(system: System) -> str:
    """Return the text of a launch file."""
    file, *_ = rossystem_launch(system, CONTEXT).values()
    return file.text


CHOICES: Mapping[str, tuple[Scalar, ...]] = {
    "robot": ("robot", "r2", "a/b"),
    "topic": ("scan", "/front/scan", "near/scan"),
    "speed": (0.5, 0.0, 1.0, 1.5e-05),
    "count": (2, 1, 3, 4),
    "slam": (True, False),
    "mode": ("auto", "manual", "1"),
    "free": ("it's", "x", 'y "z" \\', "", "1.0", "true"),
}


def test_all_ways_start_the_same(tmp_path: Path) -> None:
    """Script and launch file agree with the model, in values, types and names."""
    system = load_text(tmp_path, WHOLE, eye=EYE)
    script, text = script_of(system), launch_file(system)
    chosen = random.Random(7)
    for _ in range(300):
        values = {name: chosen.choice(found) for name, found in CHOICES.items()}
        expected = as_modelled(system, values)
        given = {name: text_of(value) for name, value in values.items()}
        words = [f"{name}:={value}" for name, value in given.items()]
        assert from_script(script, words) == expected, values
        assert from_launch(text, given) == expected, values
        included = from_launch(text, given, root="/fleet")
        assert included == as_modelled(system, values, "/fleet"), values


def test_choices_that_are_passed_on(tmp_path: Path) -> None:
    """A used system compares, calculates with and writes what has been chosen for it."""
    (tmp_path / "arm.system").write_text(
        "system Arm argument side : string argument n : int argument on : bool"
        ' imports import "eye.rnd" node left : eye when side = "left" and on'
        ' parameters param frame = "${side}_${n}" param n = $n * 2 param speed = $n / 2'
        ' node right : eye when side != "left" and n > 3 or not on'
    )
    text = (
        'system S argument hand : string = "left" argument k : int = 1 argument up : bool = true'
        ' imports import "arm.system" subsystem arm : Arm(side = if k > 2 then $hand else "left",'
        ' n = if up then $k + 2 else 5, on = if hand = "x" then $up else true)'
    )
    system = load_text(tmp_path, text, eye=EYE)
    script, launched = script_of(system), launch_file(system)
    for hand, k, up in itertools.product(("left", "x", "1"), (1, 2, 3), (True, False)):
        values: dict[str, Scalar] = {"hand": hand, "k": k, "up": up}
        expected = as_modelled(system, values)
        given = {name: text_of(value) for name, value in values.items()}
        words = [f"{name}:={value}" for name, value in given.items()]
        assert from_script(script, words) == expected, values
        assert from_launch(launched, given) == expected, values


def test_conditions_on_texts_that_are_passed_on(tmp_path: Path) -> None:
    """A used system compares what it gets: a text with arguments in it, or one that is empty."""
    (tmp_path / "arm.system").write_text(
        'system Arm argument side : string argument free : string = "" imports import "eye.rnd"'
        ' node left : eye when side = "x_left" node one : eye when side in ["1_left", "a_left"]'
        ' node bare : eye when free = "" node other : eye when side != free and free != "1"'
    )
    text = (
        'system S argument robot : string = "x" argument free : string = "" imports'
        ' import "arm.system" subsystem arm : Arm(side = "${robot}_left", free = $free)'
    )
    system = load_text(tmp_path, text, eye=EYE)
    script, launched = script_of(system), launch_file(system)
    for robot in ("x", "a", "1", "b"):
        for free in ("", "1", "1.0", "b_left"):
            values = {"robot": robot, "free": free}
            expected = as_modelled(system, values)
            words = [f"{name}:={value}" for name, value in values.items()]
            assert from_script(script, words) == expected, values
            assert from_launch(launched, values) == expected, values


@settings(
    max_examples=40, deadline=None, suppress_health_check=[HealthCheck.function_scoped_fixture]
)
@given(text=systems(), data=st.data())
def test_random_systems_start_as_modelled(
    tmp_path_factory: pytest.TempPathFactory, text: str, data: st.DataObject
) -> None:
    """Conditions on nodes, settings and connections are those of the model."""
    system = load(tmp_path_factory.mktemp("started"), text)
    values = {name: data.draw(st.sampled_from(found)) for name, found in VALUES.items()}
    try:
        script, launched = script_of(system), launch_file(system)
        expected = as_modelled(system, values)
    except GenerationError:  # two nodes of one name, say
        assume(False)
    given = {name: text_of(value) for name, value in values.items()}
    assert from_script(script, [f"{n}:={v}" for n, v in given.items()]) == expected, text
    assert from_launch(launched, given) == expected, text
    included = from_launch(launched, given, root="/fleet/r1")
    assert included == as_modelled(system, values, "/fleet/r1"), text
    rows = table(system_view(resolve(system, values)))
    started = [(each.name, dict(each.environment)) for each in rows]
    assert [(name, env) for name, _, env, _ in launch.commands(launched, given)] == started, text


def test_own_remapping_stands_before_that_of_a_group(tmp_path: Path) -> None:
    """Where a launch file is included in no namespace, both are for one name."""
    system = load(
        tmp_path,
        """system S
        argument a : bool = true
        imports import "*.rnd"
        remappings remap out to /x
        topics topic /x topic /y
        node two : source when a remappings remap lib to /x remap /out to /y
        """,
    )
    for root, target in (("/", "/y"), ("/fleet", "/x")):
        (started,) = from_launch(launch_file(system), {"a": "true"}, root=root)
        assert started[3][f"{root.rstrip('/')}/out"] == target
        assert [started] == as_modelled(system, {"a": True}, root)


def test_output_is_lint_clean(tmp_path: Path) -> None:
    """The linters of ament find nothing in either file."""
    system = load_text(tmp_path, WHOLE, eye=EYE)
    write(
        {**rossystem_launch(system, CONTEXT), **rossystem_script(system, CONTEXT)}, tmp_path / "o"
    )
    assert_lint_clean(tmp_path / "o")


@pytest.mark.parametrize(
    ("word", "said"),
    [
        ("speed:=2.0", "outside [0, 2)"),
        ("speed:=fast", "is not a number"),
        ("count:=2.0", "is not an integer"),
        ("slam:=yes", "is not true or false"),
        ("mode:=Auto", "is not one of auto, manual, 1"),
        ("robot:=/a", "is not a relative namespace"),
        ("topic:=a b", "is not a name"),
        ("sped:=1", "no argument 'sped'"),
    ],
)
def test_wrong_values_are_refused(tmp_path: Path, word: str, said: str) -> None:
    """Script and launch file refuse the same values, before anything is started."""
    system = load_text(tmp_path, WHOLE, eye=EYE)
    script = script_of(system)
    with pytest.raises(ValueError, match=said.replace("[", r"\[").replace(")", r"\)")):
        from_script(script, [word])
    name, _, value = word.partition(":=")
    if name != "sped":  # launch passes on what it does not know
        with pytest.raises(ValueError, match=name):
            from_launch(launch_file(system), {name: value})


@pytest.mark.parametrize(
    ("word", "said"),
    [
        ("n:=9223372036854775808", "argument 'n': 9223372036854775808 is no integer of 64 bits"),
        ("n:=-9223372036854775809", "is no integer of 64 bits"),
        ("n:=9223372036854775807", "parameter 'n' of /eye: 9223372036854775809 is no integer of"),
    ],
)
def test_integers_have_64_bits(
    tmp_path: Path, word: str, said: str, capsys: pytest.CaptureFixture[str]
) -> None:
    """Neither an argument nor a parameter that is calculated from it has more."""
    system = load_text(
        tmp_path,
        'system S argument n : int = 1 imports import "eye.rnd"'
        " node eye : eye parameters param n = $n + 2",
        eye=EYE,
    )
    script = script_of(system)
    run = functools.partial(script.main_with_arguments, script.SYSTEM, script.ARGUMENTS)
    assert run(script.nodes, [word, "--dry-run"]) == 2
    assert said in capsys.readouterr().err
    assert from_script(script, ["n:=9223372036854775805"])
    with pytest.raises(ValueError, match=r"64 bits|'\$n \+ 2': number out of range"):
        system_to_run(system, given_values(declared_to_run(system_view(system), {}), [word]), {})


def test_numbers_to_choose_from_may_be_infinite(tmp_path: Path) -> None:
    """As defaults may be."""
    declared = "system S argument x : double = inf one_of [1.0, inf, -inf]"
    (argument,) = script_of(load_text(tmp_path, declared)).ARGUMENTS
    assert argument.choices == (1.0, float("inf"), float("-inf"))


@pytest.mark.parametrize("word", ["robot:=9", "robot:=a/9", "n:=-1", "topic:=/scan"])
def test_names_that_are_none_are_refused(
    tmp_path: Path, word: str, capsys: pytest.CaptureFixture[str]
) -> None:
    """What values make of a name is seen before anything is started, as the script is run."""
    system = load_text(
        tmp_path,
        'system S argument robot : string = "r" argument topic : string = "scan" argument n : int'
        ' = 1 imports import "eye.rnd" node eye : eye namespace $robot wirings'
        ' connect scan to "/${topic}/r${n}"',
        eye=EYE,
    )
    script = script_of(system)
    run = functools.partial(script.main_with_arguments, script.SYSTEM, script.ARGUMENTS)
    assert run(script.nodes, [word, "--dry-run"]) == 2
    assert "error: ROS 2 rejects the name '/" in capsys.readouterr().err
    run(script.nodes, ["robot:=r9", "--dry-run"])
    assert "-r scan:=/scan/r1" in capsys.readouterr().out


def test_an_argument_without_a_default_has_to_be_given(tmp_path: Path) -> None:
    """Nothing is started without it."""
    system = load_text(
        tmp_path,
        'system S argument robot : string imports import "eye.rnd" node eye : eye namespace $robot',
        eye=EYE,
    )
    script = script_of(system)
    with pytest.raises(ValueError, match="'robot' has to be given"):
        from_script(script, [])
    assert from_script(script, ["robot:=r"])[0][0] == "/r/eye"
    with pytest.raises(ValueError, match="required"):
        from_launch(launch_file(system), {})


def test_help_lists_the_arguments(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    """Type, unit, choices, bounds, default and description are told."""
    script = script_of(load_text(tmp_path, WHOLE, eye=EYE))
    run = functools.partial(script.main_with_arguments, script.SYSTEM, script.ARGUMENTS)
    with pytest.raises(SystemExit) as ended:
        run(script.nodes, ["--help"])
    assert ended.value.code == 0
    lines = " ".join(capsys.readouterr().out.split())
    assert "speed double in m/s, in [0, 2), default 0.5" in lines
    assert "mode string, one of auto, manual, 1, default auto" in lines
    assert "robot string, default robot: Prefix of all names" in lines
    assert run(script.nodes, ["slam:=perhaps"]) == 2
    assert "argument 'slam': 'perhaps' is not true or false" in capsys.readouterr().err
