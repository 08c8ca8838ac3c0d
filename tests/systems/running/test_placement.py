"""Hosts: what is started on each of them, and that nothing is lost between them."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import pytest

from deros.generators.builtin import rossystem_systemd
from deros.generators.system.script.generate import table
from deros.generators.system.view import system_view
from deros.models.system import System
from deros.systems.arguments.resolve import resolve
from deros.systems.flatten import flatten
from deros.systems.running.placement import placed
from tests.generators.system.test_arguments import launch_file, script_of
from tests.support import launch
from tests.support.systems import CONTEXT, load_text

NODE = 'node part : parts plugin "parts::Part" publishes topic out : std_msgs.Bool'
BODY = """
host robot "192.168.7.2"
host pc $station setup "/opt/${station}/setup.bash"
host cloud "relay.example.org" "Out there"
argument station : string = "192.168.7.3"
argument extra : bool = false
topics topic /out
node base : part
node eye : part on pc when extra
subsystem planning on pc {
  node planner : part
  process recorder : "record" on robot
  subsystem deep { node deepest : part on cloud node deep : part }
}
subsystem left : Arm on cloud namespace left
container boxes on pc { node loaded : part }
node also : part into boxes on pc
launch "nav.launch.xml" on pc provides { }
"""
PLACES = {
    "robot": {"/base", "planning/recorder"},
    "pc": {"/eye", "/planner", "/deep", "/boxes", "/loaded", "/also", "nav"},
    "cloud": {"/deepest", "/left/hand"},
}


@pytest.fixture
def system(tmp_path: Path) -> System:
    """Return a system on three hosts."""
    (tmp_path / "arm.system").write_text('system Arm imports import "part.rnd" node hand : part')
    (tmp_path / "nav.launch.xml").write_text("<launch/>")
    text = f'system Apart on robot imports import "part.rnd" import "arm.system" {BODY}'
    return load_text(tmp_path, text, part=NODE)


def started(system: System, **values: Any) -> set[str]:
    """Return the names of what is started for values of the arguments."""
    return {row.full_name for row in table(system_view(resolve(placed(system), values)))}


def test_flat_system_says_where_everything_is(system: System) -> None:
    """The innermost `on` counts; used systems are where they are put."""
    flat = flatten(resolve(system, {"extra": True}))
    found: dict[str, set[str]] = {}
    for program in flat.programs:
        found.setdefault(program.host, set()).add(program.full_name)
    assert found == PLACES


@pytest.mark.parametrize("host", PLACES)
def test_each_host_starts_what_is_on_it(system: System, host: str, tmp_path: Path) -> None:
    """Table, script and launch file, with all other arguments as they are."""
    assert started(system, host=host, extra=True) == PLACES[host]
    assert started(system, host=host) == PLACES[host] - {"/eye"}
    script = script_of(system)
    words = [f"host:={host}", "extra:=true"]
    rows = script.nodes(script.given(script.ARGUMENTS, words))
    assert {row.full_name for row in rows} == PLACES[host]
    given = {"host": host, "extra": "true"}
    found = launch.started(launch_file(system), given, str(tmp_path))
    names = {name for name in PLACES[host] if name.startswith("/")} - {"/loaded", "/also"}
    assert {name for name, *_ in found} == names


def test_hosts_together_start_everything_once(system: System) -> None:
    """So does one computer for all of them."""
    parts = [started(system, host=host, extra=True) for host in PLACES]
    assert sum(map(len, parts)) == len(set().union(*parts))
    assert set().union(*parts) == started(system, host="all", extra=True)


def test_host_has_to_be_given(system: System) -> None:
    """Nothing is started on a computer by mistake."""
    script = script_of(system)
    for words in ([], ["host:=pc2"], ["host:="]):
        with pytest.raises(ValueError, match="host"):
            script.given(script.ARGUMENTS, words)
    with pytest.raises(ValueError, match="host"):
        launch.started(launch_file(system), {})


def test_units_are_for_one_host(tmp_path: Path) -> None:
    """The host is given when they are generated, as any argument."""
    text = (
        'system Apart imports import "part.rnd" topics topic /out host robot "r" host pc "p"'
        " node a : part on robot node b : part on pc"
    )
    system = load_text(tmp_path, text, part=NODE)
    for host, unit in (("robot", "apart-a"), ("pc", "apart-b")):
        files = rossystem_systemd(system, CONTEXT, {"arguments": f"host:={host}"})
        assert {name for name in files if name.endswith(".service")} == {f"systemd/{unit}.service"}
    with pytest.raises(ValueError, match="host"):
        rossystem_systemd(system, CONTEXT)


def test_system_without_hosts_is_left_alone(tmp_path: Path) -> None:
    """It has no further argument."""
    system = load_text(tmp_path, 'system S imports import "part.rnd" node a : part', part=NODE)
    assert placed(system) is system


def test_address_and_setup_file_have_values(system: System) -> None:
    """They are computed as any text, and nothing else of a host is."""
    resolved_hosts = resolve(system, {"station": "me@desk"}).hosts
    assert [(each.address, each.setup) for each in resolved_hosts] == [
        ("192.168.7.2", ""),
        ("me@desk", "/opt/me@desk/setup.bash"),
        ("relay.example.org", ""),
    ]
    assert not any(list(each.computed) for each in resolved_hosts)
