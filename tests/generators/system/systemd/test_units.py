"""Units of systemd: their text, their commands as they are run, and what they refuse."""

from __future__ import annotations

import json
import os
import shlex
import subprocess
import sys
from collections.abc import Mapping
from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st

from deros.generators.api.protocol import GenerationError
from deros.generators.builtin import rossystem_systemd
from deros.generators.node.python.generate import generate
from deros.generators.output.writer import write
from deros.generators.system.script.generate import table
from deros.generators.system.script.standalone.command_line import command_line
from deros.generators.system.systemd.units import specified, word
from deros.generators.system.view import system_view
from deros.models.system import System
from tests.support.golden import Golden
from tests.support.needs import needs
from tests.support.node_packages import model_of
from tests.support.ros import Peer, running
from tests.support.stand_ins import make_prefix
from tests.support.systems import CONTEXT, EVERYTHING, load, load_text
from tests.support.units import Unit, expanded, read_unit, words_of

WORKER = """
    node worker : demo
      executable "arguments"
    parameters
      name text : string = ""
      name rate : double = 1.0
      name max-age : double = 1.0
"""


def system(folder: Path, body: str, node: str = WORKER) -> System:
    """Load a system of nodes that are called ``worker``."""
    return load_text(folder, f"system Robot {body}", worker=node)


def units(model: System, **options: str) -> dict[str, Unit]:
    """Return the units of a system by the names of their files."""
    files = rossystem_systemd(model, CONTEXT, options)
    return {Path(path).name: read_unit(file.text) for path, file in files.items()}


def environment(unit: Unit, folder: Path, **others: str) -> Mapping[str, str]:
    """Return the environment that a program of a unit gets, besides what its setup file adds."""
    return {"PATH": os.environ["PATH"], **unit.environment({"S": str(folder)}), **others}


def setup_file(folder: Path, **variables: str) -> str:
    """Write a setup file that exports variables, and return its path."""
    path = folder / "the setup.bash"
    lines = (f"export {name}={shlex.quote(value)}\n" for name, value in variables.items())
    path.write_text("".join(lines))
    return str(path)


def test_units_match_golden(golden: Golden) -> None:
    """The texts for a system with every construct match the reviewed ones."""
    golden.check("rossystem_systemd", rossystem_systemd(load(EVERYTHING), CONTEXT))


@needs("systemd-analyze")
def test_systemd_accepts_the_units(tmp_path: Path) -> None:
    """``systemd-analyze verify`` has nothing to say about any of them."""
    write(rossystem_systemd(load(EVERYTHING), CONTEXT), tmp_path)
    paths = sorted(map(str, (tmp_path / "systemd").iterdir()))
    assert len(paths) > 3
    command = ["systemd-analyze", "verify", "--man=no", *paths]
    done = subprocess.run(command, capture_output=True, text=True, check=False)
    assert (done.returncode, done.stderr) == (0, "")


# Words --------------------------------------------------------------------------------------------


@given(st.lists(st.text(st.characters(codec="utf-8", exclude_characters="\0")), max_size=4))
def test_words_are_read_back(texts: list[str]) -> None:
    """Blanks, quotes, backslashes, control characters and specifiers survive."""
    line = " ".join(word(specified(text)) for text in texts)
    assert "\n" not in line
    assert [expanded(each, {}) for each in words_of(line)] == texts


@pytest.mark.parametrize(
    ("text", "spelled"),
    [
        ("-r", "-r"),
        ("", '""'),
        ("a b", '"a b"'),
        ('say "a"', "'say \"a\"'"),
        ('it\'s "a"', "'it\\'s \"a\"'"),
        ("#", '"#"'),
        (";", '";"'),
        ("a\\b\n", '"a\\\\b\\x0a"'),
    ],
)
def test_words_are_quoted_as_systemd_wants(text: str, spelled: str) -> None:
    """The forms are those of systemd.syntax(7); no line begins as a comment does."""
    assert word(text) == spelled


# Commands -----------------------------------------------------------------------------------------


@needs("bash", "env")
def test_unit_runs_what_the_script_runs(tmp_path: Path) -> None:
    """Each word arrives as the script gives it; the enclave comes on top."""
    hard = json.dumps('it\'s 100%h $HOME \\ ; # "x"')
    body = f"""
        imports import "*.rnd"
        subsystem front namespace front {{
          node a : worker log_level debug
          arguments ["--calm", {hard}, "$$"]
          prefix "env MORE=\\"a  b\\""
          parameters param text = {hard} param rate = 3
        }}
    """
    model = system(tmp_path, body)
    prefix = make_prefix(tmp_path / "pre fix")
    (row,) = table(system_view(model))
    setup = setup_file(tmp_path, AMENT_PREFIX_PATH=f"/nowhere:{prefix}")
    unit = units(model, setup=setup)["robot-front-a.service"]
    env = environment(unit, tmp_path)
    done = subprocess.run(unit.command(), env=env, capture_output=True, text=True, check=True)
    expected = command_line(row, ["program"])
    assert expected[:3] == ["env", "MORE=a  b", "program"]
    assert json.loads(done.stdout) == [*expected[3:], "--enclave", "/front/a"]


@needs("bash", "env")
def test_variables_replace_what_the_setup_file_sets(tmp_path: Path) -> None:
    """They reach the program as they are written, and come last."""
    value = 'it\'s 100%h $HOME \\ ; # "x"'
    body = f"""
        imports import "*.rnd"
        node a : teller
        env VALUE = {json.dumps(value)}
        env PYTHONPATH = "/mine"
    """
    prefix = make_prefix(tmp_path / "prefix")
    setup = setup_file(tmp_path, AMENT_PREFIX_PATH=str(prefix), PYTHONPATH="/setup", VALUE="x")
    model = system(tmp_path, body, 'node teller : demo executable "environment"')
    unit = units(model, setup=setup)["robot-a.service"]
    env = environment(unit, tmp_path)
    done = subprocess.run(unit.command(), env=env, capture_output=True, text=True, check=True)
    found = json.loads(done.stdout)
    assert found["VALUE"] == value
    assert found["PYTHONPATH"] == "/mine"
    assert found["ROS_HOME"] == f"{tmp_path}/robot"


@needs("bash")
def test_process_runs_in_its_folder_with_its_words(tmp_path: Path) -> None:
    """A process that is no node is looked up in the ``PATH`` that the setup file makes."""
    prefix = make_prefix(tmp_path / "prefix")
    body = f"""
        process recorder : "arguments"
        arguments ["a b", "$x"]
        cwd "{tmp_path}/100%"
    """
    setup = setup_file(tmp_path, PATH=f"{prefix}/lib/demo:{os.environ['PATH']}")
    unit = units(system(tmp_path, body), setup=setup)["robot-recorder.service"]
    env = environment(unit, tmp_path)
    done = subprocess.run(unit.command(), env=env, capture_output=True, text=True, check=True)
    assert json.loads(done.stdout) == ["a b", "$x"]
    assert expanded(unit.value("Service", "WorkingDirectory"), {}) == f"{tmp_path}/100%"


@needs("bash")
def test_missing_program_and_missing_setup_file_are_named(tmp_path: Path) -> None:
    """The journal says what is missing, and the unit has failed."""
    model = system(tmp_path, 'imports import "*.rnd" node a : worker')
    for setup, said in (
        (setup_file(tmp_path, AMENT_PREFIX_PATH="/nowhere"), "package demo has no program"),
        ("/nowhere/setup.bash", "/nowhere/setup.bash: No such file"),
    ):
        unit = units(model, setup=setup)["robot-a.service"]
        env = environment(unit, tmp_path)
        done = subprocess.run(unit.command(), env=env, capture_output=True, text=True, check=False)
        assert done.returncode != 0
        assert said in done.stderr


@needs("bash")
@pytest.mark.ros
def test_node_comes_up_under_its_name_and_enclave(
    tmp_path: Path, ros_env: dict[str, str], ros_peer: Peer
) -> None:
    """The command of a unit is run as it stands, and its process ends by SIGINT."""
    node = "node worker : works publishes topic out : std_msgs.Bool"
    body = """
        imports import "*.rnd"
        subsystem front namespace front { node eye : worker wirings connect out to /seen }
    """
    model = system(tmp_path, body, node)
    described, context = model_of(tmp_path / "worker.rnd")
    write(generate(described, context, {}), tmp_path / "src")
    program = tmp_path / "prefix/lib/works/worker"
    program.parent.mkdir(parents=True)
    program.write_text(f"#!{sys.executable}\nfrom works.worker import main\nmain()\n")
    program.chmod(0o755)
    path = os.pathsep.join(filter(None, [str(tmp_path / "src/works"), os.getenv("PYTHONPATH")]))
    ament = os.pathsep.join([str(tmp_path / "prefix"), ros_env["AMENT_PREFIX_PATH"]])
    setup = setup_file(tmp_path, PYTHONPATH=path, AMENT_PREFIX_PATH=ament)
    unit = units(model, setup=setup)["robot-front-eye.service"]
    with running(unit.command(), {**ros_env, **environment(unit, tmp_path)}) as process:
        names = ros_peer.node.get_node_names_and_namespaces_with_enclaves
        ros_peer.until(lambda: ("eye", "/front", "/front/eye") in names())
        ros_peer.until(lambda: ros_peer.node.get_publishers_info_by_topic("/seen"))
    assert process.returncode == 0
    assert unit.value("Service", "KillSignal") == "SIGINT"


# Settings -----------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("respawn", "interval", "burst", "restart", "delay"),
    [
        ("", [], [], [], []),
        ("respawn", ["0"], [], ["always"], ["0"]),
        ("respawn delay 1500 ms max 3", ["infinity"], ["4"], ["always"], ["1.5"]),
    ],
)
def test_respawn_becomes_restart(
    respawn: str,
    interval: list[str],
    burst: list[str],
    restart: list[str],
    delay: list[str],
    tmp_path: Path,
) -> None:
    """Three restarts are four starts; without ``respawn`` nothing is started again."""
    found = units(system(tmp_path, f'imports import "*.rnd" node a : worker {respawn}'))
    unit = found["robot-a.service"]
    assert unit.values("Unit", "StartLimitIntervalSec") == interval
    assert unit.values("Unit", "StartLimitBurst") == burst
    assert unit.values("Service", "Restart") == restart
    assert unit.values("Service", "RestartSec") == delay


def test_target_wants_all_and_manager_comes_after_its_nodes(tmp_path: Path) -> None:
    """What activates others is started after them and stopped before them."""
    (tmp_path / "managed.rnd").write_text("node managed : demo lifecycle")
    body = """
        imports import "*.rnd"
        subsystem front namespace front { node a : managed activated by manager }
        node manager : worker
        process recorder : "true"
    """
    found = units(system(tmp_path, body))
    wanted = ["robot-front-a.service", "robot-manager.service", "robot-recorder.service"]
    assert found["robot.target"].values("Unit", "Wants") == wanted
    assert sorted(found) == sorted([*wanted, "robot.target"])
    for name in wanted:
        after = ["robot-front-a.service"] if name == "robot-manager.service" else []
        assert found[name].values("Unit", "After") == after
        assert found[name].value("Unit", "PartOf") == "robot.target"


ARGUMENTS = """
    imports import "*.rnd"
    argument second : bool = false
    argument rate : int in [1, 9]
    argument twice : int = $rate * 2
    node a : worker parameters param rate = $twice
    node b : worker when second
"""


def test_units_hold_the_values_that_are_given(tmp_path: Path) -> None:
    """Conditions decide which units there are; computed defaults follow what is given."""
    model = system(tmp_path, ARGUMENTS)
    few = units(model, arguments="rate:=2")
    assert sorted(few) == ["robot-a.service", "robot.target"]
    assert "rate:=4.0" in few["robot-a.service"].command()
    more = units(model, arguments="rate:=2 second:=true twice:=7")
    assert sorted(more) == ["robot-a.service", "robot-b.service", "robot.target"]
    assert "rate:=7.0" in more["robot-a.service"].command()


# What is refused ----------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("options", "message"),
    [
        ({}, "argument 'rate' has to be given"),
        ({"arguments": "rate:=10"}, "argument 'rate': 10 is outside"),
        ({"arguments": "rate:=1 third:=1"}, "no argument 'third'"),
        ({"arguments": "rate:='1"}, "cannot be taken apart: No closing quotation"),
        ({"arguments": "rate:=1", "setup": "install/setup.bash"}, "not an absolute path"),
        ({"arguments": "rate:=1", "setup": "/a\nb"}, "not an absolute path"),
    ],
)
def test_wrong_options_are_refused(options: dict[str, str], message: str, tmp_path: Path) -> None:
    """The message says what is wrong, as the script's does."""
    with pytest.raises(ValueError, match=message):
        units(system(tmp_path, ARGUMENTS), **options)


@pytest.mark.parametrize(
    ("body", "message"),
    [
        ("node a : managed autostart", "do not bring 'a' to active"),
        ('argument x : string = env("X", "y") node a : worker namespace $x', "is looked up"),
        ("node a : worker parameters param max-age = 2", "no command line of ROS 2 can hold"),
        ('node a : worker parameters from "a.yaml"', "'a' reads parameter files"),
        ('process p : "true" cwd "logs"', "folder 'logs' of 'p' is relative"),
        ('process p : "true" delay 1 sec', "'delay' of 'p' is not in its unit"),
        ("container box delay 1 sec { }", "'delay' of 'box' is not in its unit"),
        ('process p : "true" after service /x', "'after service' of 'p' is not in its unit"),
        ("node a : worker on exit stop all", "'on exit stop all' of 'a' is not in its unit"),
        (
            'node a : worker process p : "true" after exit of a',
            "'after exit of' of 'p' is not in its unit",
        ),
        ('process p : "bin/run"', "program 'bin/run' of 'p' is a relative path"),
    ],
)
def test_what_units_cannot_do_is_refused(body: str, message: str, tmp_path: Path) -> None:
    """The finding names it, and where it is written."""
    (tmp_path / "managed.rnd").write_text("node managed : demo lifecycle")
    (tmp_path / "a.yaml").write_text("a: {ros__parameters: {rate: 2.0}}")
    model = system(tmp_path, f'imports import "*.rnd" {body}')
    with pytest.raises(GenerationError) as error:
        rossystem_systemd(model, CONTEXT)
    (found,) = error.value.diagnostics
    assert found.code.name == "DRS402"
    assert message in found.message


def test_two_programs_of_one_unit_are_refused(tmp_path: Path) -> None:
    """A process may be called like a node; its unit would be the node's."""
    model = system(tmp_path, 'imports import "*.rnd" node a : worker process a : "true"')
    with pytest.raises(GenerationError) as error:
        rossystem_systemd(model, CONTEXT)
    assert [each.code.name for each in error.value.diagnostics] == ["DRS401"]
