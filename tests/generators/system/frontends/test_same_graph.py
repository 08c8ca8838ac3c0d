"""However a system is started, what runs on the real middleware is what the model says.

The script and ``deros up`` run everywhere; the three launch files where ``DEROS_REAL_PYTHON`` names
a Python that imports ``launch_ros``, ``launch_xml`` and ``launch_yaml``.
"""

from __future__ import annotations

import copy
import subprocess
from collections.abc import Mapping
from pathlib import Path
from shutil import which

import pytest

from tests.support import started_graph
from tests.support.ros import LIMIT, own_domain, running
from tests.support.started_site import (
    OURS,
    THEIRS,
    Site,
    Values,
    compare,
    flat_system,
    graph_peer,
    sets,
    site_at,
)

ROBOT: Mapping[str, Values] = {
    "defaults": {},
    "others": {"speed": 1.5, "slam": False, "count": 3, "robot": "r2", "mode": "by hand"},
    "few": {"mode": "1", "count": 1, "tuning": "files/other.yaml"},
}
FURTHER: Mapping[str, Values] = {"defaults": {}, "others": {"slam": False, "robot": "r2"}}
LAUNCHES = FURTHER


@pytest.fixture
def site(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Site:
    """Return a folder with the systems, and an install space with their programs."""
    return site_at(tmp_path, monkeypatch)


def _xacro(site: Site, **arguments: object) -> str:
    """Return what xacro itself makes of the file."""
    words = [f"{name}:={value}" for name, value in arguments.items()]
    path = str(site.folder / "files/world.xacro")
    return subprocess.run(
        [str(site.prefix / "bin/xacro"), path, *words], capture_output=True, text=True, check=True
    ).stdout


def _description(site: Site, values: Values) -> Mapping[str, str]:
    """Return what xacro makes of the description in the first system, by its place in the model."""
    left = f"{values.get('robot', 'r1')} left"
    text = _xacro(site, robot=left, count=values.get("count", 2))
    return {'from xacro "files/world.xacro" (robot = "${robot} left", count = $count)': text}


@pytest.mark.ros
@pytest.mark.parametrize("starter", [*OURS, *THEIRS])
@pytest.mark.parametrize("values", sets(ROBOT))
@pytest.mark.essential
def test_what_all_can_do_is_started_as_modelled(site: Site, values: Values, starter: str) -> None:
    """Nodes, ports, parameters, words, variables, folders, niceness, restarts, and the end."""
    compare(site, starter, "robot", values, _description(site, values), "host:=all")


@pytest.mark.ros
@pytest.mark.parametrize("starter", [*OURS, *THEIRS[:1]])
@pytest.mark.parametrize("values", sets(FURTHER))
def test_what_three_can_do_is_started_as_modelled(site: Site, values: Values, starter: str) -> None:
    """Files that are made, nodes in a process, later starts, and managed nodes."""
    text = _xacro(site, robot=values.get("robot", "r1"), count=3)
    compare(site, starter, "further", values, {"/world": ["world", text]})
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
@pytest.mark.parametrize("values", sets(LAUNCHES))
def test_existing_launch_files_are_started_as_modelled(
    site: Site, values: Values, starter: str
) -> None:
    """With arguments, namespaces, parameters, parameter files, variables and remappings."""
    compare(site, starter, "launches", values, {})


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
@pytest.mark.essential
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
    compare(site, starter, "robot", {}, text, "host:=all", "robto:=r2")


@pytest.mark.ros
def test_comparison_finds_what_differs(site: Site) -> None:
    """A wrong value, a topic of another name, a word, and a process that is not there."""
    command = site.command("script", "further", "slam:=false")
    flat = flat_system(site.folder / "further.system", {"slam": False})
    with (
        own_domain() as domain,
        graph_peer(domain) as peer,
        running(command, site.environment(domain)),
    ):
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
