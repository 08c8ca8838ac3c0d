"""Compose files: their text, their commands as they are run, and what they refuse."""

from __future__ import annotations

import json
import os
import subprocess
from pathlib import Path
from typing import Any

import pytest
import yaml
from hypothesis import example, given
from hypothesis import strategies as st

from deros.generators.api.protocol import GenerationError
from deros.generators.builtin import rossystem_compose
from deros.generators.system.compose.spelling import block, quoted
from deros.generators.system.script.generate import table
from deros.generators.system.view import system_view
from deros.models.system import System
from deros.systems.arguments.resolve import resolve
from deros.systems.running.placement import placed
from tests.support.golden import Golden
from tests.support.needs import needs
from tests.support.stand_ins import load_system, make_prefix
from tests.support.systems import CONTEXT, load_text

TEXTS = st.text(
    st.one_of(
        st.sampled_from(
            [*" $\"'\\#:-{}[]&*!|>%@`,?=~\t\n\r", "é", "\u2028", "\ufeff", "\x85", "\x07"]
        ),
        st.characters(exclude_categories=["Cs"]),
    ),
    max_size=30,
)
HOSTS = """
host robot "robot" setup "install/setup.bash"
host pc $station "Beside the field"
argument station : string = "pc"
argument greeting : string = "hello"
"""
NODES = """
node base : steady on robot "Drives; costs $5" respawn delay 1 sec
subsystem left "Of the left arm" namespace left {
  node r : reader on pc
    parameters from "config/rates.yaml"
    parameters
      param max-age = 2.5
      param rate = 3
}
node c : arguments on pc arguments [$greeting, "it's $HOME", "no"]
  env GREETING = "a b"
  prefix "nice -n 5"
process bag : "ros2" arguments ["bag", "record", "-a"] cwd "/data" on pc
"""
READER = """
node reader : demo
  executable "arguments"
parameters
  name rate : int = 1
  name max-age : double = 1.0
"""
RATES = "# it costs $5\n/**:\n  ros__parameters:\n    rate: 7\n"


LOAD_MONITOR = """\
import "deros:load_monitor.rnd"
node l : load_monitor
parameters
  param node = "l"
"""


def model(folder: Path, members: str = HOSTS + NODES) -> System:
    """Load a system of stand-ins, and of a node that reads a parameter file."""
    (folder / "config").mkdir(exist_ok=True)
    (folder / "config" / "rates.yaml").write_text(RATES)
    return load_system(folder, members, READER)


def composed(system: System, **options: str) -> dict[str, Any]:
    """Return what compose reads in the files of a system, by their names."""
    files = rossystem_compose(system, CONTEXT, options)
    return {path: interpolated(yaml.safe_load(file.text)) for path, file in files.items()}


def interpolated(found: Any) -> Any:
    """Return data with the variables of compose resolved: each is the text between its braces."""
    if isinstance(found, dict):
        return {key: interpolated(each) for key, each in found.items()}
    if isinstance(found, list):
        return [interpolated(each) for each in found]
    if not isinstance(found, str) or found.startswith("${"):
        return found
    assert "$" not in found.replace("$$", ""), found
    return found.replace("$$", "$")


# Text -------------------------------------------------------------------------------------------


def test_compose_files_match_golden(tmp_path: Path, golden: Golden) -> None:
    """One for each host, with what is on it."""
    golden.check("rossystem_compose", rossystem_compose(model(tmp_path), CONTEXT))


def test_each_host_has_its_services(tmp_path: Path) -> None:
    """A host that is given gets its file alone; with all, everything is in one."""
    system = model(tmp_path)
    found = composed(system)
    assert {path: [*each["services"]] for path, each in found.items()} == {
        "robot.robot.compose.yaml": ["base"],
        "robot.pc.compose.yaml": ["left-r", "c", "bag"],
    }
    one = composed(system, arguments="host:=pc greeting:=ho")
    assert [*one] == ["robot.pc.compose.yaml"]
    assert one["robot.pc.compose.yaml"]["services"]["c"]["command"][2] == "ho"
    everything = composed(system, arguments="host:=all")
    assert len(everything["robot.compose.yaml"]["services"]) == 4
    plain = composed(model(tmp_path, "node a : steady"))
    assert plain["robot.compose.yaml"]["name"] == "robot"


def test_services_hold_what_compose_needs(tmp_path: Path) -> None:
    """Networks and shared memory of the host, the signal that nodes know, and a first process."""
    files = composed(model(tmp_path), image="registry.example.org/robot:1.0")
    services = {**files["robot.robot.compose.yaml"]["services"]}
    services |= files["robot.pc.compose.yaml"]["services"]
    for each in services.values():
        assert each["image"] == "registry.example.org/robot:1.0"
        assert (each["network_mode"], each["ipc"], each["init"]) == ("host", "host", True)
        assert (each["stop_signal"], each["stop_grace_period"]) == ("SIGINT", "10s")
        assert each["environment"]["ROS_DOMAIN_ID"] is None
        assert all(isinstance(word, str) for word in each["entrypoint"] + each["command"])
    assert services["base"]["restart"] == "unless-stopped"
    assert {services[name]["restart"] for name in ("left-r", "c", "bag")} == {"no"}
    assert services["bag"]["working_dir"] == "/data"


def test_image_has_to_be_named_at_the_start(tmp_path: Path) -> None:
    """Without the option, compose asks for it."""
    (found,) = composed(model(tmp_path, "node a : steady")).values()
    assert found["services"]["a"]["image"].startswith("${ROBOT_IMAGE:?")


def test_parameter_files_are_in_the_compose_file(tmp_path: Path) -> None:
    """So is what no command line can hold; a container has each where its command says."""
    found = composed(model(tmp_path))["robot.pc.compose.yaml"]
    service = found["services"]["left-r"]
    texts = {
        each["target"]: found["configs"][each["source"]]["content"] for each in service["configs"]
    }
    command = service["command"]
    given = [command[at + 1] for at, word in enumerate(command) if word == "--params-file"]
    assert given == [*texts]
    assert texts[given[0]] == RATES
    assert yaml.safe_load(texts[given[1]]) == {
        "/left/r": {"ros__parameters": {"max-age": 2.5, "rate": 3}}
    }


def test_manager_is_started_after_its_nodes(tmp_path: Path) -> None:
    """What brings others to active depends on them."""
    system = load_text(
        tmp_path,
        'system Robot imports import "*.rnd" node eye : eye activated by boss node boss : boss',
        eye="node eye : demo lifecycle",
        boss="node boss : demo",
    )
    (found,) = composed(system).values()
    assert found["services"]["boss"]["depends_on"] == ["eye"]
    assert "depends_on" not in found["services"]["eye"]


@given(TEXTS)
@example("$HOME ${x} $$")
@example("no")
@example("1.0")
@example("a, b: c")
def test_any_text_is_read_back(text: str) -> None:
    """As a word and as the text of a file, whatever YAML and compose would make of it."""
    for spelled in (quoted(text), block(text, 4)):
        read = yaml.safe_load(f"key: {spelled}\n")["key"]
        assert read == text.replace("$", "$$")


@pytest.mark.parametrize("text", [RATES, "a\n b\n\n c\n", "a:\n  b\n"])
def test_usual_file_is_a_block(text: str) -> None:
    """It can be reviewed as it is."""
    assert block(text, 4).startswith("|\n    ")


# As it runs -------------------------------------------------------------------------------------


@needs("bash", "nice")
def test_commands_run_what_the_script_runs(tmp_path: Path) -> None:
    """With the words, the variables and the prefix of the table, after the setup file."""
    prefix = make_prefix(tmp_path / "prefix")
    setup = tmp_path / "setup.bash"
    setup.write_text(f"export AMENT_PREFIX_PATH='{prefix}' GREETING=other\n")
    (folder := tmp_path / "m").mkdir()
    system = model(folder)
    service = composed(system, setup=str(setup))["robot.pc.compose.yaml"]["services"]["c"]
    done = subprocess.run(
        service["entrypoint"] + service["command"],
        env={"PATH": os.environ["PATH"]},
        capture_output=True,
        text=True,
        check=True,
    )
    rows = table(system_view(resolve(placed(system), {"host": "pc"})))
    (row,) = (each for each in rows if each.name == "c")
    assert json.loads(done.stdout) == [
        *row.arguments,
        *("--ros-args", "-r", "__node:=c", "-r", "__ns:=/"),
    ]
    seen = [*service["entrypoint"], "demo", "environment"]
    shown = subprocess.run(seen, env={"PATH": os.environ["PATH"]}, capture_output=True, check=True)
    assert json.loads(shown.stdout)["GREETING"] == "a b"


# Refused ----------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("members", "said"),
    [
        ("node a : steady delay 1 sec", "'delay' of 'a' is not in its service: compose starts all"),
        ("node a : short node b : steady after exit of a", "'after exit of' of 'b'"),
        ("node a : short on exit stop all", "'on exit stop all'"),
        ("node a : steady respawn max 3", "compose knows no 'max' for 'a'"),
        ('process p : "x" cwd "data"', "where it leads is a matter of the image"),
        ('process p : "./x"', "is a relative path: where it leads"),
        ('node r : reader parameters from "/etc/rates.yaml"', "is where it is on this computer"),
        ('node r : reader parameters from "share:nav2/rates.yaml"', "is in a package of the image"),
        ('node r : reader parameters from "config/rates.yaml" below x', "is made when"),
        ('argument a : string = env("A") process p : "x" arguments [$a]', "compose files hold"),
        ('launch "arm.launch.xml" provides { }', "a service of compose is for one program"),
        (LOAD_MONITOR, "so 'l' would find no node whose load it can measure"),
    ],
)
def test_what_compose_cannot_do_is_refused_by_name(tmp_path: Path, members: str, said: str) -> None:
    """Nothing is left out in silence."""
    (tmp_path / "arm.launch.xml").write_text("<launch/>")
    system = model(tmp_path, members)
    with pytest.raises(GenerationError) as error:
        rossystem_compose(system, CONTEXT)
    assert said in "\n".join(each.message for each in error.value.diagnostics)


def test_two_services_of_one_name_are_refused(tmp_path: Path) -> None:
    """A path in the graph and its name with dashes become the same."""
    both = 'subsystem a namespace a { node b : steady } subsystem a { process b : "x" }'
    with pytest.raises(GenerationError) as error:
        rossystem_compose(model(tmp_path, both), CONTEXT)
    assert "both become 'a-b'" in error.value.diagnostics[0].message


def test_wrong_options_are_refused(tmp_path: Path) -> None:
    """A setup file is one in the image; arguments are read as by the script."""
    system = model(tmp_path)
    for options in ({"setup": "x"}, {"arguments": "host:=mars"}, {"arguments": "'"}):
        with pytest.raises(ValueError, match=r"setup|host|apart"):
            rossystem_compose(system, CONTEXT, options)
