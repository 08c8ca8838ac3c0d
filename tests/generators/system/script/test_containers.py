"""Nodes are loaded into real containers: in order, again after a restart, or everything stops."""

from __future__ import annotations

import os
import re
import signal
import subprocess
import sys
import time
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import pytest

from deros.generators.builtin import rossystem_script
from deros.generators.output.writer import write
from deros.generators.system.script.standalone.supervisor import INTERRUPTED
from tests.support import boxed, pages
from tests.support.cpp import python_overlay
from tests.support.needs import needs
from tests.support.ros import Peer
from tests.support.stand_ins import Run
from tests.support.systems import CONTEXT, load_text

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
    model = load_text(folder, text, camera=boxed.CAMERA, sink=boxed.SINK)
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
    return boxed.installed(tmp_path_factory.mktemp("workspace"))


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


@pytest.mark.ros
@needs("rclcpp")
def test_values_of_files_come_to_the_nodes(start: Start, ros_peer: Peer, tmp_path: Path) -> None:
    """Files known at the start only, a made one among them; again the same after a restart."""
    conf = tmp_path / "conf"
    conf.mkdir()
    (conf / "one.yaml").write_text("/**: {ros__parameters: {label: a, rate: 1.0}}")
    (conf / "two.yaml").write_text("camera: {ros__parameters: {rate: 2.5}}")
    run = start(FILES.replace("container main", "container main respawn"), f"conf:={conf}")
    run.until("[loading] 1 of 1 containers have their nodes")
    wanted = {"/front/camera": ("own", 2.5), "/plain": ("none", 1.0)}
    assert {name: values(ros_peer, name) for name in wanted} == wanted
    (conf / "two.yaml").write_text("camera: {ros__parameters: {rate: 3.5}}")
    os.kill(run.started()["main"], signal.SIGKILL)
    run.until("[loading] 1 of 1 containers have their nodes", times=2)
    assert {name: values(ros_peer, name) for name in wanted} == wanted
    run.signal(signal.SIGINT)
    assert run.end() == INTERRUPTED


@pytest.mark.ros
@needs("rclcpp")
def test_container_that_starts_later_holds_nobody_up(start: Start, tmp_path: Path) -> None:
    """Neither the other containers nor their managed nodes wait for it, or for what is in it."""
    mark = tmp_path / "mark"
    os.mkfifo(mark)
    run = start(
        f'process first : "{sys.executable}" arguments ["-ISc", "open(\'{mark}\').close()"]'
        " container late after exit of first { node camera : camera node lamp : sink autostart }"
        " container main { node sink : sink autostart }"
    )
    run.until("[loading] 1 of 2 containers have their nodes", "[bring-up] 1 of 2 managed nodes")
    assert "late" not in run.started()
    assert said(run, "loading")[0] == "/sink loaded into /main"
    mark.open("w").close()
    run.until("[loading] 2 of 2 containers have their nodes", "[bring-up] 2 of 2 managed nodes")
    run.signal(signal.SIGINT)
    assert run.end() == INTERRUPTED


def values(peer: Peer, name: str) -> tuple[str, float]:
    """Return the parameters ``label`` and ``rate`` of a node."""
    from rcl_interfaces.srv import GetParameters

    client = peer.node.create_client(GetParameters, f"{name}/get_parameters")
    request = GetParameters.Request(names=["label", "rate"])
    asked: list[Any] = []

    def answer() -> Any:
        """Ask again after a while: the service may be that of a process that was killed."""
        if client.service_is_ready() and (not asked or time.monotonic() - asked[-1][0] > 1.0):
            asked.append((time.monotonic(), client.call_async(request)))
        return next((future.result() for _, future in asked if future.done()), None)

    label, rate = peer.until(answer).values
    return label.string_value, rate.double_value


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


def refusal(folder: Path, body: str, *components: str, modules: Path | None = None) -> str:
    """Return what a script says that starts nothing.

    It runs under Python without ROS 2, unless it is given ``modules`` that this lacks here.
    """
    script = script_of(folder, body)
    python = Path(sys.base_prefix, "bin", f"python3.{sys.version_info.minor}")
    where = prefix(folder / "install", *components)
    command = [sys.executable if modules else python, script, "--package-path", where]
    run = Run(command, {"PATH": os.environ["PATH"], "PYTHONPATH": str(modules or "")})
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


FILES = """
argument conf : string = "conf"
container main {
  node camera : camera namespace /front
    parameters from "${conf}/one.yaml"
    parameters from "${conf}/two.yaml" below "front"
    parameters param label = "own"
  node plain : camera
}
"""
"""Nodes with and without parameter files that are only known at the start."""


def with_files(folder: Path, one: str, two: str = "") -> Path:
    """Write the parameter files; return a folder with what this Python may lack of ROS 2."""
    (folder / "conf").mkdir()
    (folder / "conf/one.yaml").write_text(one)
    (folder / "conf/two.yaml").write_text(two)
    modules = folder / "modules"
    (modules / "composition_interfaces").mkdir(parents=True)
    return modules


@pytest.mark.parametrize(
    ("one", "two", "why"),
    [
        ("/**:\n  rate: 5\n", "", "one.yaml: Cannot have a value before ros__parameters at line 2"),
        ("", "camera: {ros__parameters: {rate: []}}", "'rate' below 'front/camera' has no value"),
    ],
)
def test_nothing_is_started_when_ros_refuses_a_file(
    tmp_path: Path, one: str, two: str, why: str
) -> None:
    """The node is named, and what ROS 2 says about its file: also about a made one."""
    pytest.importorskip("rclpy")
    modules = with_files(tmp_path, one, two)
    text = refusal(tmp_path, FILES, "boxed::Camera", modules=modules)
    first, second = text.splitlines()
    assert first == "Parameters of nodes in containers cannot be read, so nothing was started:"
    assert second.startswith("  /front/camera: ")
    assert why in second


def test_nothing_is_started_without_a_file(tmp_path: Path) -> None:
    """As for a node that is a process."""
    text = refusal(tmp_path, FILES, "boxed::Camera")
    assert text.splitlines() == [
        "Files not found, so nothing was started:",
        *(f"  {tmp_path}/conf/{name}.yaml" for name in ("one", "two")),
    ]


@needs("bash")
def test_command_of_a_dry_run_passes_the_values_of_files(tmp_path: Path) -> None:
    """It works as it stands, and later values win: its own are the last."""
    pytest.importorskip("rclpy")
    with_files(
        tmp_path,
        "/**: {ros__parameters: {label: a, rate: 1}}",
        'camera: {ros__parameters: {rate: 2.5, "words": ["b c", "d\'e"]}}',
    )
    script = script_of(tmp_path, FILES)
    where = prefix(tmp_path / "install", "boxed::Camera")
    run = Run([sys.executable, script, "--dry-run", "--package-path", where], {})
    try:
        assert run.end() == 0
    finally:
        run.close()
    made = next(line for line in run.lines if line.startswith("mkdir"))
    command = run.lines[run.lines.index("# /front/camera") + 1]
    tool = tmp_path / "bin/ros2"
    tool.parent.mkdir()
    tool.write_text(f"#!{sys.executable} -IS\nimport sys\nprint(*sys.argv[1:], sep='\\n')\n")
    tool.chmod(0o755)
    path = f"{tmp_path}/bin:{Path(sys.executable).parent}:{os.environ['PATH']}"
    text = f"{made}\n{command}"
    found = subprocess.run(
        ["bash", "-c", text], env={"PATH": path}, capture_output=True, text=True, check=False
    )
    assert found.returncode == 0, found.stderr
    words = found.stdout.splitlines()
    assert words[:5] == ["component", "load", "/main", "boxed", "boxed::Camera"]
    given = [words[at + 1] for at, word in enumerate(words) if word == "--parameter"]
    assert given == ['label:="a"', "rate:=2.5", 'words:=["b c", "d\'e"]', 'label:="own"']
    assert "runpy" not in run.lines[-1]  # the other node has no file


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
