"""Nodes are loaded into real containers: in order, again after a restart, or everything stops."""

from __future__ import annotations

import os
import re
import signal
import sys
from collections.abc import Callable, Iterator
from pathlib import Path

import pytest

from deros.generators.builtin import rossystem_script
from deros.generators.output.writer import write
from deros.generators.system.script.standalone.supervisor import INTERRUPTED
from tests.support import pages
from tests.support.cli import deros
from tests.support.cpp import colcon_build, python_overlay
from tests.support.needs import needs
from tests.support.ros import Peer
from tests.support.stand_ins import Run
from tests.support.systems import CONTEXT, load_text

PLAIN = """node camera : boxed plugin "boxed::Camera"
parameters
  name label : string = "none"
  name rate : double = 1.0 in [0, 10]
publishes topic image : std_msgs.String
"""
MANAGED = """node sink : boxed plugin "boxed::Sink" lifecycle
subscribes topic image : std_msgs.String
"""
BODY = """
argument composed : bool = true
topics topic /image
container main namespace /boxes RESPAWN {
  node camera : camera namespace /front parameters param label = "left"
  wirings connect image to /image
}
node sink : sink autostart into main when composed wirings connect image to /image
"""

Start = Callable[..., Run]


def script_of(folder: Path, body: str) -> Path:
    """Generate the script of a system of these nodes."""
    folder.mkdir(exist_ok=True)
    text = f'system Boxes imports import "*.rnd" {body}'
    model = load_text(folder, text, camera=PLAIN, sink=MANAGED)
    write(rossystem_script(model, CONTEXT), folder)
    return folder / "boxes.py"


def said(run: Run, label: str) -> list[str]:
    """Return what one process has said."""
    mark = f"[{label}] "
    return [line.removeprefix(mark) for line in run.lines if line.startswith(mark)]


# On real containers -------------------------------------------------------------------------------


@pytest.fixture(scope="module")
def installed(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Return an install folder with the components that are generated of the descriptions."""
    folder = tmp_path_factory.mktemp("workspace")
    for name, text in (("camera", PLAIN), ("sink", MANAGED)):
        (folder / f"{name}.rnd").write_text(text)
    files = (folder / "camera.rnd", folder / "sink.rnd")
    assert deros("generate", *files, "--target", "cpp", "-o", folder / "src").code == 0
    return colcon_build(folder / "src")


@pytest.fixture
def start(installed: Path, tmp_path: Path, ros_env: dict[str, str]) -> Iterator[Start]:
    """Return a function that starts the script of a system."""
    runs: list[Run] = []

    def start_script(body: str, *arguments: str) -> Run:
        script = script_of(tmp_path / f"models{len(runs)}", body)
        runs.append(Run([sys.executable, script, *arguments], python_overlay(installed, ros_env)))
        return runs[-1]

    yield start_script
    for run in runs:
        run.close()


@pytest.mark.ros
@needs("rclcpp")
def test_nodes_are_loaded_and_brought_up(start: Start, ros_peer: Peer) -> None:
    """Their names in the graph are those of the model: not in the container's namespace."""
    run = start(BODY.replace("RESPAWN", ""))
    run.until("[bring-up] 1 of 1 managed nodes are active")
    assert said(run, "loading") == [
        "/front/camera loaded into /boxes/main",
        "/sink loaded into /boxes/main",
        "1 of 1 containers have their nodes",
    ]
    wanted = {("main", "/boxes"), ("camera", "/front"), ("sink", "/")}
    ros_peer.until(lambda: wanted <= set(ros_peer.node.get_node_names_and_namespaces()))
    ros_peer.until(lambda: ros_peer.node.count_publishers("/image") == 1)
    run.signal(signal.SIGINT)
    assert run.end() == INTERRUPTED
    assert said(run, "bring-up")[-1] == "/sink shut down"


@pytest.mark.ros
@needs("rclcpp")
def test_page_shows_what_is_printed(start: Start) -> None:
    """The lines in ``docs/running.md`` are those of such a system, but for the processes."""
    (page,) = (
        block.text
        for block in pages.blocks()
        if (block.page, block.language) == ("docs/running.md", "text") and "loading" in block.text
    )
    run = start(
        "container main { node lens : camera namespace /front "
        "node rectifier : camera namespace /front }"
    )
    run.until("[loading] 1 of 1 containers have their nodes")
    printed = [line for line in run.lines if line.startswith(("[Boxes]", "[loading]"))]
    assert [re.sub(r"\d{2,}", "N", line) for line in printed] == [
        re.sub(r"\d{2,}", "N", line.replace("[Vision]", "[Boxes]")) for line in page.splitlines()
    ]


@pytest.mark.ros
@needs("rclcpp")
def test_node_is_a_process_where_it_is_not_composed(start: Start) -> None:
    """The other one is loaded all the same."""
    run = start(BODY.replace("RESPAWN", ""), "composed:=false")
    run.until("[bring-up] 1 of 1 managed nodes are active", "[loading] 1 of 1 containers")
    assert "sink" in run.started()
    assert said(run, "loading")[0] == "/front/camera loaded into /boxes/main"


@pytest.mark.ros
@needs("rclcpp")
def test_container_that_is_started_again_gets_its_nodes_again(start: Start) -> None:
    """Also when it was killed, so that the graph still shows the one before."""
    run = start(BODY.replace("RESPAWN", "respawn"))
    run.until("[bring-up] 1 of 1 managed nodes are active")
    os.kill(run.started()["main"], signal.SIGKILL)
    run.until("[bring-up] 1 of 1 managed nodes are active", times=2)
    once = ["/front/camera", "/sink"]
    assert [line.split()[0] for line in said(run, "loading") if "loaded" in line] == once * 2


@pytest.mark.ros
@needs("rclcpp")
def test_killed_container_has_not_loaded_anything(start: Start) -> None:
    """What was not loaded before its end is never said to be."""
    run = start(BODY.replace("RESPAWN", ""))
    run.until("main started, process")
    os.kill(run.started()["main"], signal.SIGKILL)
    assert run.end() == 1
    assert not any("containers have their nodes" in line for line in run.lines)
    assert any("main was killed by SIGKILL" in line for line in run.lines)


@pytest.mark.ros
@needs("rclcpp")
def test_node_that_cannot_be_loaded_stops_everything(start: Start) -> None:
    """The container's own words are passed on; nothing is loaded after it."""
    run = start(
        "container main { node camera : camera parameters param rate = 20.0 }"
        " node sink : sink into main"
    )
    assert run.end() == 1
    (line,) = said(run, "loading")
    assert line.startswith("/main does not have its nodes: /camera cannot be loaded: ")
    assert "rate" in line
    assert "[Boxes] stopping: loading has failed" in run.lines


@pytest.mark.ros
@needs("rclcpp")
def test_missing_container_elsewhere_stops_everything(start: Start) -> None:
    """It is waited for as long as the page says."""
    run = start("node camera : camera into /existing/container")
    assert run.end() == 1
    (line,) = said(run, "loading")
    assert line.endswith("no service /existing/container/_container/load_node within 10 s")


@pytest.mark.ros
@needs("rclcpp")
def test_nodes_are_not_loaded_twice_into_a_container_elsewhere(start: Start) -> None:
    """A second start finds the node of the first one, and leaves it alone."""
    box = start("container box { }")
    box.until("box started, process")
    first = start("node camera : camera into /box")
    first.until("[loading] 1 of 1 containers have their nodes")
    first.signal(signal.SIGINT)
    assert first.end() == INTERRUPTED
    second = start("node camera : camera into /box")
    assert second.end() == 1
    assert said(second, "loading") == [
        "/box does not have its nodes: it has a node /camera already"
    ]


# Before the start ---------------------------------------------------------------------------------


def prefix(folder: Path, *components: str) -> Path:
    """Install a container's program, which is never run, and the index of a package."""
    program = folder / "lib/rclcpp_components/component_container"
    index = folder / "share/ament_index/resource_index/rclcpp_components/boxed"
    for path in (program, index):
        path.parent.mkdir(parents=True)
    program.write_text(f"#!{sys.executable}\n")
    program.chmod(0o755)
    index.write_text("".join(f"{each};lib/libboxed.so\n" for each in components))
    return folder


def refusal(folder: Path, body: str, *components: str, bare: bool = True) -> str:
    """Return what a script says that starts nothing, under Python without ROS 2 if ``bare``."""
    script = script_of(folder, body)
    python = Path(sys.base_prefix, "bin", f"python3.{sys.version_info.minor}")
    where = prefix(folder / "install", *components)
    command = [python if bare else sys.executable, script, "--package-path", where]
    run = Run(command, {"PATH": os.environ["PATH"]})
    try:
        assert run.end() == 2
    finally:
        run.close()
    text = "\n".join(run.lines)
    assert "started, process" not in text
    return text


def test_nothing_is_started_without_composition_interfaces(tmp_path: Path) -> None:
    """What is missing is named, with the package to install."""
    text = refusal(tmp_path, "container main { node camera : camera }", "boxed::Camera")
    assert "has no rclpy and no composition_interfaces, so nothing was started" in text
    assert "composition-interfaces" in text


def test_nothing_is_started_when_a_class_is_not_registered(tmp_path: Path) -> None:
    """It is looked up where the container would look it up."""
    text = refusal(tmp_path, "container main { node camera : camera }", "boxed::Other")
    assert "/camera: package 'boxed' registers no component 'boxed::Camera'" in text


def test_nothing_is_started_without_the_program_of_the_container(tmp_path: Path) -> None:
    """A container is a program of its package."""
    body = "container main isolated { node camera : camera }"
    text = refusal(tmp_path, body, "boxed::Camera")
    assert "package 'rclcpp_components' has no program 'component_container_isolated'" in text


def test_dry_run_prints_the_commands_that_load(tmp_path: Path) -> None:
    """They are those of ``ros2 component load``, with all that the node is given."""
    body = """
    container main namespace /boxes {
      node camera : camera namespace /front intra_process parameters param label = "a b"
      wirings connect image to /image
    }
    """
    script = script_of(tmp_path, body)
    where = prefix(tmp_path / "install", "boxed::Camera")
    run = Run([sys.executable, script, "--dry-run", "--package-path", where], {})
    try:
        assert run.end() == 0
    finally:
        run.close()
    assert run.lines[-2:] == [
        "# /front/camera",
        "ros2 component load /boxes/main boxed boxed::Camera --node-name camera --node-namespace "
        "/front --remap-rule image:=/image --parameter 'label:=\"a b\"' --extra-argument "
        "use_intra_process_comms:=true",
    ]
