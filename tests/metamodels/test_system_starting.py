"""When the programs of a system are started, and whether their exit stops all."""

from __future__ import annotations

from pathlib import Path

import pytest

from deros import codes
from deros.interfaces.durations import NS_PER_S
from deros.metamodels.load import Repository
from deros.models.programs import Respawn
from deros.models.starting import AT_ONCE
from deros.models.system import NodeInstance, System
from tests.support.systems import load_text

CONTAINER = "container n MODIFIERS { }"


def test_modifiers_of_nodes_and_processes(tmp_path: Path) -> None:
    """They stand in any order; `delay` behind `respawn` is that of restarts."""
    found = load_text(
        tmp_path,
        """system s imports import "*.rnd"
        node a : a on exit stop all after exit of left/x delay 2 sec
        process b : "b" delay 1 sec respawn delay 3 sec after exit of a "B"
        process c : "c" on exit stop all
        """,
        a="node a : p",
    )
    (node,) = found.members
    assert isinstance(node, NodeInstance)
    assert (node.starting.awaited, node.starting.delay_s) == ("left/x", 2.0)
    assert node.starting.stops_all is not None
    assert node.starting.stops_all.text == "on exit stop all"
    b, c = found.processes
    assert (b.starting.awaited, b.starting.delay_s, b.starting.stops_all) == ("a", 1.0, None)
    assert (b.respawn, b.description) == (Respawn(3 * NS_PER_S), "B")
    assert (c.starting.is_later, c.starting.stops_all is None) == (False, False)


def test_modifiers_of_containers(tmp_path: Path) -> None:
    """They are those of the container's process, not of what is loaded into it."""
    found = load_text(
        tmp_path,
        """system s imports import "*.rnd" process first : "first"
        container delay isolated after exit of first on exit stop all respawn if $x delay 2 sec
        { node after : a }
        container exit delay 3 sec on exit stop all "All" { node stop : a }
        argument x : bool = false
        """,
        a='node a : p plugin "a::A"',
    )
    one, after, other, stop = (each for each in found.members if isinstance(each, NodeInstance))
    assert (one.starting.awaited, one.starting.delay_s) == ("first", 0.0)
    assert one.starting.stops_all is not None
    assert one.respawn is not None
    assert (other.starting.delay_s, other.description) == (3.0, "All")
    assert [each.starting for each in (after, stop)] == [AT_ONCE, AT_ONCE]


def test_what_is_waited_for_in_the_graph(tmp_path: Path) -> None:
    """A program by its name, an end by a graph name, each with a time; with one `after` at most."""
    found = load_text(
        tmp_path,
        """system s imports import "*.rnd"
        argument robot : string = "x"
        topics external topic "/${robot}/go" external topic /out
        node a : a after node g/b timeout 500 ms delay 1 sec
        subsystem g { node b : a autostart }
        process c : "c" after active g/b respawn
        process d : "d" after service "/${robot}/go" timeout 2 min "D"
        process e : "e" after topic /out
        """,
        a="node a : p lifecycle",
    )
    node = found.members[0]
    assert isinstance(node, NodeInstance)
    starts = [node.starting, *(each.starting for each in found.processes)]
    ready = [each.ready for each in starts]
    assert [None if each is None else (each.kind, each.name, each.timeout_s) for each in ready] == [
        ("node", "g/b", 0.5),
        ("active", "g/b", 60.0),
        ("service", "/${robot}/go", 120.0),
        ("topic", "/out", 60.0),
    ]
    assert [each is not None and each.name_from is not None for each in ready] == [
        *(False, False, True, False)
    ]
    assert node.starting.delay_s == 1.0
    assert all(each.is_later for each in starts)
    assert found.processes[1].description == "D"


def test_words_of_the_graph_are_names_elsewhere(tmp_path: Path) -> None:
    """Programs, topics and hosts may be called like them, also where they are waited for."""
    found = load_text(
        tmp_path,
        """system active imports import "*.rnd"
        topics external topic service external topic topic : std_msgs.Bool external topic active
        node node : a node active : a node timeout : a
        process service : "x" after node node process topic : "x" after node active
        process after : "x" after node timeout timeout 1 sec
        process exit : "x" after service service timeout 1 sec
        """,
        a="node a : p",
    )
    assert [each.name for each in found.members] == ["node", "active", "timeout"]
    ready = [each.starting.ready for each in found.processes]
    assert [each and each.name for each in ready] == ["node", "active", "timeout", "service"]


def test_words_are_names_elsewhere(tmp_path: Path) -> None:
    """Nodes, topics and subsystems may be called like the new keywords."""
    found = load_text(
        tmp_path,
        """system delay imports import "*.rnd"
        topics external topic after : std_msgs.Bool external topic exit external topic stop
        subsystem of { node exit : a node all : a autostart on failure stop }
        process stop : "stop" after exit of of/exit
        node after : a after exit of stop
        """,
        a="node a : p lifecycle",
    )
    assert [each.name for each in found.members] == ["of", "after"]
    assert found.processes[0].starting.awaited == "of/exit"


@pytest.mark.parametrize(
    ("modifiers", "code", "place"),
    [
        ("delay 0 sec", codes.BAD_DURATION, "0 sec"),
        ("delay 1 sec delay 2 sec", codes.DUPLICATE_SECTION, "delay 2 sec"),
        ("after exit of a after exit of b", codes.DUPLICATE_SECTION, "after exit of b"),
        ("on exit stop all on exit stop all", codes.DUPLICATE_SECTION, "on exit stop all"),
        ("respawn max 3 delay 2 sec", codes.SYNTAX_ERROR, "delay 2 sec"),
        ("after exit of /a", codes.SYNTAX_ERROR, "/a"),
        ("on exit start x", codes.SYNTAX_ERROR, "start"),
        ("after node a timeout 0 sec", codes.BAD_DURATION, "0 sec"),
        ("after node a timeout 5", codes.UNKNOWN_UNIT, "5"),
        ("after exit of a after node b", codes.DUPLICATE_SECTION, "after node b"),
        ("after node a after topic /b", codes.DUPLICATE_SECTION, "after topic /b"),
        ("after active /a", codes.SYNTAX_ERROR, "/a"),
    ],
)
@pytest.mark.parametrize("start", ["node n : a MODIFIERS", 'process n : "n" MODIFIERS', CONTAINER])
def test_bad_modifiers_are_reported(
    tmp_path: Path, start: str, modifiers: str, code: object, place: str
) -> None:
    """Each gives one finding, at its place."""
    (tmp_path / "a.rnd").write_text("node a : p")
    path = tmp_path / "s.system"
    text = start.replace("MODIFIERS", modifiers)
    path.write_text(f'system s imports import "*.rnd" {text}\n')
    repository = Repository()
    repository.load(path)
    assert [(each.code, each.span.text) for each in repository.diagnostics] == [(code, place)]


def test_provided_nodes_are_started_by_the_launch_file(tmp_path: Path) -> None:
    """What says how a node is started is refused there, and nothing follows from it."""
    (tmp_path / "a.rnd").write_text("node a : p")
    (tmp_path / "l.launch.xml").write_text("<launch/>")
    path = tmp_path / "s.system"
    path.write_text(
        'system s imports import "*.rnd" launch "l.launch.xml" provides {'
        " node n : a delay 1 sec after exit of x on exit stop all }\n"
    )
    repository = Repository()
    loaded = repository.load(path)
    found = [(each.code, each.span.text) for each in repository.diagnostics]
    places = ["delay 1 sec", "after exit of x", "on exit stop all"]
    assert found == [(codes.SYNTAX_ERROR, each) for each in places]
    assert isinstance(loaded.model, System)


def test_hosts_and_what_is_on_them(tmp_path: Path) -> None:
    """`on` is for programs and groups, in any order with the other modifiers."""
    found = load_text(
        tmp_path,
        """system s on robot "All" imports import "*.rnd"
        host robot "192.168.7.2" setup "~/it's here/setup.bash" "The rover"
        host pc "${lab}.example.org" setup "/opt/${lab}/setup.bash"
        argument lab : string = "x"
        node a : a on exit stop all on pc respawn
        node b : a on pc on exit stop all
        container c multi_threaded on pc { node d : a }
        process e : "e" on robot delay 1 sec
        subsystem g namespace /g on pc { node host : a node on : a }
        """,
        a='node a : p plugin "a::A"',
    )
    assert [(each.name, each.address_from is None) for each in found.hosts] == [
        ("robot", True),
        ("pc", False),
    ]
    assert found.hosts[0].description == "The rover"
    assert found.hosts[0].setup == "~/it's here/setup.bash"
    assert len(list(found.hosts[1].computed)) == 2
    assert str(found.host) == "robot"
    assert [str(each.host) for each in found.members] == ["pc"] * 5
    for each in found.members[:2]:
        assert isinstance(each, NodeInstance)
        assert each.starting.stops_all is not None
    assert [str(each.host) for each in found.processes] == ["robot"]
