"""Containers that run, and the nodes in them: imported, verified and watched."""

from __future__ import annotations

import sys
import time
from collections.abc import Iterator
from contextlib import closing
from dataclasses import replace
from pathlib import Path

import pytest

from deros.interfaces.durations import NS_PER_S
from deros.live.looks import snapshot
from deros.live.observer import Observer
from deros.live.verify import watching
from deros.live.verify.differences import Kind
from deros.live.verify.expectation import expectation
from deros.live.verify.graces import Event
from deros.live.verify.texts import line
from deros.systems.flatten import flatten
from tests.support.built_interfaces import LIST_NODES, known
from tests.support.needs import needs
from tests.support.ros import LIMIT, Peer, read_line, running
from tests.support.shell import deros_at
from tests.support.systems import load

PROGRAM = str(Path(__file__).resolve().parent.parent / "support" / "container_program.py")

pytestmark = [pytest.mark.ros]


@pytest.fixture(scope="module")
def built(tmp_path_factory: pytest.TempPathFactory) -> Iterator[dict[str, str]]:
    """Give what processes need to know the service, as this one does then."""
    with known(LIST_NODES, tmp_path_factory.mktemp("composition")) as variables:
        yield variables


@pytest.fixture
def env(built: dict[str, str], ros_env: dict[str, str]) -> dict[str, str]:
    """Give the environment of processes that know the service."""
    return ros_env | built


def container(name: str, *components: str) -> list[str]:
    """Return the command of a container."""
    return [sys.executable, PROGRAM, name, *components]


@needs("gcc")
def test_containers_are_imported_and_verified(env: dict[str, str], tmp_path: Path) -> None:
    """With the commands: what was imported is so, until a container has other nodes."""
    system = tmp_path / "robot.system"
    with running(container("main", "/left", "/far/right"), env) as main:
        assert read_line(main) == "up\n"
        with running(container("other", "/middle"), env) as other:
            assert read_line(other) == "up\n"
            outcome = deros_at(env, "import", "--live", "-o", str(tmp_path))
            same = deros_at(env, "verify", "--live", str(system))
        assert (outcome.code, outcome.err) == (0, "")
    nodes = {each.full_name: each.container for each in flatten(load(system)).nodes}
    assert nodes == {
        "/far/right": "/main",
        "/left": "/main",
        "/main": None,
        "/middle": "/other",
        "/other": None,
    }
    assert (same.code, same.out) == (0, f"{system}: 5 nodes, no difference\n")
    with running(container("main", "/far/right"), env) as main:
        assert read_line(main) == "up\n"
        with running(container("other", "/middle", "/left"), env) as other:
            assert read_line(other) == "up\n"
            moved = deros_at(env, "verify", "--live", str(system))
    assert moved.code == 1
    found = [each.partition("  (")[0] for each in moved.out.splitlines()]
    assert found == [
        "wrong-container /left: /other in place of /main",
        f"{system}: 5 nodes, 1 difference",
    ]


@needs("gcc")
def test_component_that_is_made_before_it_is_listed(
    env: dict[str, str], ros_peer: Peer, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """A watch asks the container when a node comes, and again until it has that."""
    from std_srvs.srv import SetBool

    monkeypatch.setattr(watching, "ASK_S", 0.5)
    client = ros_peer.node.create_client(SetBool, "/main_take")
    path = tmp_path / "robot.system"
    (tmp_path / "eye.rnd").write_text(
        'node eye : eyes\nplugin "eyes::Eye"\npublishes topic ~/image : std_msgs.Bool\n'
    )
    path.write_text(
        'system Eyes\nimports import "eye.rnd"\n'
        "topics\n  external topic /left/image\n  external topic /late/image\n"
        "container main {\n"
        "  node left : eye wirings connect ~/image to /left/image\n"
        "  node late : eye wirings connect ~/image to /late/image\n}\n"
    )
    expected = expectation(flatten(load(path)), ignored=["/test_peer"])
    with running(container("main", "/left"), env) as main:
        assert read_line(main) == "up\n"
        with Observer(int(env["ROS_DOMAIN_ID"])) as observer:
            first = snapshot(observer, timeout=LIMIT, described=False)
            # What else is there of a node comes after the node: it is not what this is about.
            graces = dict.fromkeys(Kind, 1000 * NS_PER_S)
            graces |= dict.fromkeys((Kind.MISSING_NODE, Kind.WRONG_CONTAINER), 0)
            with closing(watching.Watch(observer, expected, first, graces)) as watch:

                def next_lines(*lines: str) -> None:
                    found: list[Event] = []
                    deadline = time.monotonic() + LIMIT
                    while len(found) < len(lines) and time.monotonic() < deadline:
                        found += watch.turn()
                    said = [line(replace(each.difference, span=None)) for each in found]
                    ends = ["back: " if each.is_over else "" for each in found]
                    assert [*map("".join, zip(ends, said, strict=True))] == [*lines]

                next_lines("missing-node /late")
                assert ros_peer.call(client, SetBool.Request(data=False)).success
                wrong = "wrong-container /late: a process of its own in place of /main"
                next_lines("back: missing-node /late", wrong)
                assert ros_peer.call(client, SetBool.Request(data=True)).success
                next_lines(f"back: {wrong}")


@needs("gcc")
def test_container_is_a_node_where_its_service_is_unknown(
    env: dict[str, str], tmp_path: Path
) -> None:
    """Who lacks the package of the service is told so, and compares all the rest."""
    with running(container("main", "/left"), env) as main:
        assert read_line(main) == "up\n"
        poor = {**env, "PYTHONPATH": str(_without_package(tmp_path))}
        outcome = deros_at(poor, "import", "--live", "-o", str(tmp_path / "models"))
    assert (outcome.code, outcome.err) == (1, "")
    told = (
        "  /main was not asked which nodes are in it: the package composition_interfaces of ROS 2 "
        "cannot be imported",
        "  /main is a container: which nodes are in it is not known",
    )
    assert set(told) <= set(outcome.out.splitlines())
    assert {each.container for each in flatten(load(tmp_path / "models/robot.system")).nodes} == {
        None
    }


def _without_package(folder: Path) -> Path:
    """Return a folder that hides the package from Python, also where ROS 2 has it."""
    hidden = folder / "modules"
    hidden.mkdir()
    (hidden / f"{LIST_NODES.package}.py").write_text("raise ImportError\n")
    return hidden
