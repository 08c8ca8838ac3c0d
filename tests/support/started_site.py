"""A place where systems are started in five ways, and what runs is compared with the model."""

from __future__ import annotations

import contextlib
import os
import shutil
import signal
import sys
from collections.abc import Collection, Iterator, Mapping
from dataclasses import dataclass
from pathlib import Path

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
from tests.support import started_graph
from tests.support.arguments import text_of
from tests.support.frontend_files import both
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
"""Arguments by name."""


def sets(found: Mapping[str, Values]) -> list[ParameterSet]:
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


def site_at(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Site:
    """Return a folder with the systems, and an install space with their programs.

    What a starter needs to find them is in the environment until the test is over.
    """
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


def flat_system(path: Path, values: Values) -> FlatSystem:
    """Return what the model says, with the files of installed packages."""
    repository = Repository()
    repository.parameter_files.share = InterfaceStore().share
    model = repository.load(path).model
    assert isinstance(model, System)
    return flatten(resolve(model, values))


def compare(
    site: Site,
    starter: str,
    name: str,
    values: Values,
    texts: Mapping[str, object],
    *more: str,
    silent: Collection[str] = (),
) -> None:
    """Start a system, compare it with the model, and end it by the exit that stops all.

    Args:
        site: where the system is.
        starter: one of :data:`OURS` and :data:`THEIRS`.
        name: of the system.
        values: of its arguments.
        texts: what stands where the model has a text that is known at the start only.
        more: further words for the starter.
        silent: packages whose programs do not tell what they were given.
    """
    flat = flat_system(site.folder / f"{name}.system", values)
    known = {"share:robot_maps": str(site.prefix / "share/robot_maps"), **texts}
    expected = started_graph.expected_graph(flat, known, silent)
    words = [f"{name}:={text_of(value)}" for name, value in values.items()]
    command = site.command(starter, name, *words, *more)
    with own_domain() as domain, graph_peer(domain) as peer, _without_leavings(site):
        with running(command, site.environment(domain)) as process:
            found = started_graph.await_graph(expected, site.told, peer)
            different = [*started_graph.differences(found, expected)]
            assert not different, different
            site.end.write_text("")  # the reader's exit stops all
            process.communicate(timeout=LIMIT)
            assert process.returncode == 0, process.returncode
        assert processes_with(f"DEROS_TEST_TOLD={site.told}") == []


@contextlib.contextmanager
def _without_leavings(site: Site) -> Iterator[None]:
    """End what a starter that has failed leaves behind, so that no other test meets it."""
    try:
        yield
    finally:
        for each in processes_with(f"DEROS_TEST_TOLD={site.told}"):
            with contextlib.suppress(ProcessLookupError):
                os.kill(each, signal.SIGKILL)


@contextlib.contextmanager
def graph_peer(domain: int) -> Iterator[Peer]:
    """Look at the graph of a domain for a while."""
    peer = Peer(domain)
    try:
        yield peer
    finally:
        peer.close()
