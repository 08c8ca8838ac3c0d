"""However a system is started, what runs on the real middleware is what the model says.

The script and ``deros up`` run everywhere; the three launch files where ``DEROS_REAL_PYTHON`` names
a Python that imports ``launch_ros``, ``launch_xml`` and ``launch_yaml``.
"""

from __future__ import annotations

import contextlib
import copy
import os
import shutil
import subprocess
import sys
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from pathlib import Path
from shutil import which

import pytest
from _pytest.mark import ParameterSet

from deros.generators.builtin import rossystem_launch, rossystem_script
from deros.generators.output.writer import write
from deros.interfaces.store import InterfaceStore
from deros.metamodels.load import Repository
from deros.models.common import Scalar
from deros.models.system import System
from deros.systems.arguments.resolve import resolve
from deros.systems.flat import FlatSystem
from deros.systems.flatten import flatten
from tests.generators.system.frontends.test_frontends import both
from tests.generators.system.test_arguments import text_of
from tests.support import started_graph
from tests.support.processes import processes_with
from tests.support.ros import LIMIT, Peer, environment, own_domain, running
from tests.support.systems import CONTEXT, MODELS, load

PYTHON = os.environ.get("DEROS_REAL_PYTHON", "")
LAUNCH = """
import sys
from launch import LaunchDescription, LaunchService
from launch.actions import IncludeLaunchDescription
from launch.launch_description_sources import AnyLaunchDescriptionSource

given = [tuple(word.split(":=", 1)) for word in sys.argv[2:]]
service = LaunchService(argv=sys.argv[2:], noninteractive=True)
source = AnyLaunchDescriptionSource(sys.argv[1])
included = IncludeLaunchDescription(source, launch_arguments=given)
service.include_launch_description(LaunchDescription([included]))
sys.exit(service.run())
"""
"""What ``ros2 launch`` does."""

OURS = ("script", "up")
THEIRS = tuple(
    pytest.param(
        f"launch.{each}",
        marks=pytest.mark.skipif(
            not PYTHON, reason="DEROS_REAL_PYTHON names no Python that has launch_ros"
        ),
    )
    for each in ("py", "xml", "yaml")
)

Values = Mapping[str, Scalar]
ROBOT: Mapping[str, Values] = {
    "defaults": {},
    "others": {"speed": 1.5, "slam": False, "count": 3, "robot": "r2", "mode": "by hand"},
    "few": {"mode": "1", "count": 1, "tuning": "files/other.yaml"},
}
FURTHER: Mapping[str, Values] = {"defaults": {}, "others": {"slam": False, "robot": "r2"}}
LAUNCHES = FURTHER


def _sets(found: Mapping[str, Values]) -> list[ParameterSet]:
    """Return the values as parameters of a test; only the defaults are quick."""
    return [
        pytest.param(each, id=name, marks=[pytest.mark.slow] if each else [])
        for name, each in found.items()
    ]


@dataclass(frozen=True)
class Site:
    """Where a system is started: its folder, and the install space of its programs."""

    folder: Path
    prefix: Path
    told: Path
    end: Path

    def command(self, starter: str, system: str, *words: str) -> list[str]:
        """Return the command that starts a system, generated beside it."""
        path = self.folder / f"{system}.system"
        if starter == "up":
            return [str(Path(sys.executable).with_name("deros")), "up", str(path), *words]
        model = load(path)
        if starter == "script":
            write(rossystem_script(model, CONTEXT), self.folder)
            return [sys.executable, str(self.folder / f"{system}.py"), *words]
        files = rossystem_launch(model, CONTEXT) if starter == "launch.py" else both(model)
        write(files, self.folder)
        return [PYTHON, "-c", LAUNCH, str(self.folder / f"{system}.{starter}"), *words]

    def environment(self, domain: int) -> dict[str, str]:
        """Return the one that a system is started in."""
        return environment(domain) | {"ROS_HOME": str(self.told.parent / "ros_home")}


@pytest.fixture
def site(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Site:
    """Return a folder with the systems, and an install space with their programs."""
    found = Site(*(tmp_path / each for each in ("started", "prefix", "told", "end")))
    shutil.copytree(MODELS / "started", found.folder)
    found.told.mkdir()
    os.mkfifo(found.end)
    types = {
        node.type.name: node.type
        for name in ("robot", "further")
        for node in flatten(load(found.folder / f"{name}.system")).nodes
        if node.type is not None
    }
    started_graph.install(
        found.prefix,
        {
            ("eyes", "eye"): (types["eye"],),
            ("parts", "any_part"): (types["part"],),
            ("crew", "member"): (types["member"],),
            ("control", "manager"): (types["manager"], types["wheels"]),
        },
    )
    (found.prefix / "bin/xacro").symlink_to(Path(sys.executable).with_name("xacro"))
    (found.prefix / "share/ament_index/resource_index/packages/robot_maps").touch()
    maps = found.prefix / "share/robot_maps"
    maps.mkdir()
    for robot, speed in (("r1", "0.75"), ("r2", "0.875")):
        (maps / f"{robot}.yaml").write_text(
            f"/{robot}/eye: {{ros__parameters: {{lens: {{name: {robot}}}, speed: {speed}}}}}\n"
        )
    prefixes = os.environ.get("AMENT_PREFIX_PATH", sys.prefix)
    for name, value in {
        **{n: v for n, v in environment(0).items() if n.startswith(("FASTRTPS", "ROS_AUTO"))},
        "AMENT_PREFIX_PATH": f"{found.prefix}{os.pathsep}{prefixes}",
        "PATH": f"{found.prefix / 'bin'}{os.pathsep}{os.environ['PATH']}",
        "DEROS_TEST_TOLD": str(found.told),
        "DEROS_TEST_END": str(found.end),
    }.items():
        monkeypatch.setenv(name, value)
    return found


def _xacro(site: Site, **arguments: object) -> str:
    """Return what xacro itself makes of the file."""
    words = [f"{name}:={value}" for name, value in arguments.items()]
    path = str(site.folder / "files/world.xacro")
    return subprocess.run(
        [str(site.prefix / "bin/xacro"), path, *words], capture_output=True, text=True, check=True
    ).stdout


def _flat(path: Path, values: Values) -> FlatSystem:
    """Return what the model says, with the files of installed packages."""
    repository = Repository()
    repository.parameter_files.share = InterfaceStore().share
    model = repository.load(path).model
    assert isinstance(model, System)
    return flatten(resolve(model, values))


def _compare(
    site: Site, starter: str, name: str, values: Values, texts: Mapping[str, object], *more: str
) -> None:
    """Start a system, compare it with the model, and end it by the exit that stops all."""
    flat = _flat(site.folder / f"{name}.system", values)
    known = {"share:robot_maps": str(site.prefix / "share/robot_maps"), **texts}
    expected = started_graph.expected_graph(flat, known)
    words = [f"{name}:={text_of(value)}" for name, value in values.items()]
    command = site.command(starter, name, *words, *more)
    with own_domain() as domain, _peer(domain) as peer:
        with running(command, site.environment(domain)) as process:
            found = started_graph.await_graph(expected, site.told, peer)
            assert not [*started_graph.differences(found, expected)]
            site.end.write_text("")  # the reader's exit stops all
            process.communicate(timeout=LIMIT)
            assert process.returncode == 0
        assert processes_with(f"DEROS_TEST_TOLD={site.told}") == []


@contextlib.contextmanager
def _peer(domain: int) -> Iterator[Peer]:
    peer = Peer(domain)
    try:
        yield peer
    finally:
        peer.close()


def _description(site: Site, values: Values) -> Mapping[str, str]:
    """Return what xacro makes of the description in the first system, by its place in the model."""
    left = f"{values.get('robot', 'r1')} left"
    text = _xacro(site, robot=left, count=values.get("count", 2))
    return {'from xacro "files/world.xacro" (robot = "${robot} left", count = $count)': text}


@pytest.mark.ros
@pytest.mark.parametrize("starter", [*OURS, *THEIRS])
@pytest.mark.parametrize("values", _sets(ROBOT))
def test_what_all_can_do_is_started_as_modelled(site: Site, values: Values, starter: str) -> None:
    """Nodes, ports, parameters, words, variables, folders, niceness, restarts, and the end."""
    _compare(site, starter, "robot", values, _description(site, values), "host:=all")


@pytest.mark.ros
@pytest.mark.parametrize("starter", [*OURS, *THEIRS[:1]])
@pytest.mark.parametrize("values", _sets(FURTHER))
def test_what_three_can_do_is_started_as_modelled(site: Site, values: Values, starter: str) -> None:
    """Files that are made, nodes in a process, later starts, and managed nodes."""
    text = _xacro(site, robot=values.get("robot", "r1"), count=3)
    _compare(site, starter, "further", values, {"/world": ["world", text]})
    at = started_graph.started_at(site.told)
    assert at["second"] - at["first"] >= 0.3
    robot = values.get("robot", "r1")
    for waiting, awaited in {
        **dict.fromkeys(("on_node", "on_service", "on_topic"), "eye"),
        **({"on_active": "lead"} if values.get("slam", True) else {}),
    }.items():
        assert at[waiting] > at[f"/{robot}/{awaited}"], waiting


@pytest.mark.ros
@pytest.mark.parametrize(
    "starter",
    [
        *(
            pytest.param(
                each, marks=pytest.mark.skipif(not which("ros2"), reason="there is no ros2")
            )
            for each in OURS
        ),
        *THEIRS,
    ],
)
@pytest.mark.parametrize("values", _sets(LAUNCHES))
def test_existing_launch_files_are_started_as_modelled(
    site: Site, values: Values, starter: str
) -> None:
    """With arguments, namespaces, parameters, parameter files, variables and remappings."""
    _compare(site, starter, "launches", values, {})


WRONG = (
    ("speed:=2", "speed", "[0, 2)|[0.0, 2.0)"),
    ("speed:=fast", "speed", "number"),
    ("count:=4", "count", "1, 2, 3"),
    ("slam:=maybe", "slam", "true or false|['true', 'false']"),
    ("mode:=other", "mode", "auto, by hand, 1|['auto', 'by hand', '1']"),
    ("robot:=", "robot", "less than 1 characters|a relative namespace"),
    ("robot:=/r1", "robot", "a relative namespace"),
    ("tuning:=none.yaml", "none.yaml", "Files not found|File not found|no parameter file"),
    ("host:=moon", "host", "all, base, desk|['all', 'base', 'desk']"),
    ("", "host", "has to be given|missing required argument"),
)
"""What is given, and what the message names: the argument, and in one of these ways its values."""


def _refused(site: Site, command: list[str], starter: str) -> str:
    """Return what the starter says that is to start nothing."""
    with own_domain() as domain:
        run = subprocess.run(
            command,
            env=site.environment(domain),
            stdout=subprocess.PIPE,
            stderr=subprocess.STDOUT,
            text=True,
            timeout=LIMIT,
            check=False,
        )
    assert run.returncode == (2 if starter in OURS else 1), run.stdout
    assert not [*site.told.iterdir()], run.stdout
    return run.stdout.strip()


@pytest.mark.parametrize("starter", ["script", pytest.param("up", marks=pytest.mark.slow), *THEIRS])
def test_wrong_arguments_start_nothing(site: Site, starter: str) -> None:
    """The last line names the argument and what it has to be."""
    command = site.command(starter, "robot")
    for given, name, meant in WRONG:
        words = [given, "host:=all"] if name != "host" else [*filter(None, [given])]
        said = _refused(site, [*command, *words], starter)
        last = said if name.endswith(".yaml") else said.splitlines()[-1]
        assert name in last, (given, said)
        assert any(each in last for each in meant.split("|")), (given, said)


@pytest.mark.parametrize("starter", OURS)
def test_unknown_argument_starts_nothing(site: Site, starter: str) -> None:
    """It is named, with those that there are."""
    said = _refused(site, site.command(starter, "robot", "host:=all", "robto:=r2"), starter)
    assert "'robto'" in said.splitlines()[-1]
    assert "its arguments: host, robot, speed" in said.splitlines()[-1]


@pytest.mark.ros
@pytest.mark.parametrize("starter", THEIRS)
def test_launch_takes_no_notice_of_an_unknown_argument(site: Site, starter: str) -> None:
    """As docs/running.md says: no launch file sees what was given to launch alone."""
    text = _description(site, {})
    _compare(site, starter, "robot", {}, text, "host:=all", "robto:=r2")


@pytest.mark.ros
def test_comparison_finds_what_differs(site: Site) -> None:
    """A wrong value, a topic of another name, a word, and a process that is not there."""
    command = site.command("script", "further", "slam:=false")
    flat = _flat(site.folder / "further.system", {"slam": False})
    with own_domain() as domain, _peer(domain) as peer, running(command, site.environment(domain)):
        right = started_graph.expected_graph(flat, {})
        found = started_graph.await_graph(right, site.told, peer)
        assert not [*started_graph.differences(found, right)]
        wrong = copy.deepcopy(right)
        wrong["/r1/eye"]["parameters"]["counts"] = [7]
        wrong["viewer"]["told"]["words"][0] = "/world"
        assert [*started_graph.differences(found, wrong)] == [
            " /r1/eye parameters counts: [7, 8], expected [7]",
            " viewer told words: ['', 'more'], expected ['/world', 'more']",
        ]
        wrong["/r1/eye"]["ends"].remove(("publishes", "/r1/pictures", "std_msgs/msg/Bool"))
        with pytest.raises(AssertionError, match="'/r1/eye'"):
            started_graph.await_graph(wrong, site.told, peer, 0.5)
        wrong = copy.deepcopy(right)
        wrong["second"]["told"]["starts"] = 2
        with pytest.raises(AssertionError, match="'second': 2"):
            started_graph.await_graph(wrong, site.told, peer, 0.5)
