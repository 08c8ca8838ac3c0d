"""What the page of a system holds."""

from __future__ import annotations

import json
from dataclasses import asdict
from pathlib import Path

import pytest

from deros.diagnostics import Diagnostic
from deros.models.system import System
from deros.pipeline.workspace import check_one
from deros.report.page.build import FAULTY_ARGUMENTS, build
from deros.report.page.contents import Contents, Place, Program
from tests.support.cases import DIRECTORY, all_cases, interfaces
from tests.support.systems import load_text

Courier = tuple[System, list[Diagnostic]]


def _program(page: Contents, name: str) -> Program:
    (found,) = (each for each in page.programs if each.name == name)
    return found


def test_names_and_conditions_are_trees_of_the_arguments(courier: Courier) -> None:
    """So the page can show the variant for any values, also those that no list has."""
    page = build(*courier)
    slam = _program(page, "slam")
    assert slam.full_name == ["text", "/", ["argument", "robot"], "/slam"]
    assert slam.when == [
        "and",
        ["holds", ["argument", "slam"]],
        ["!=", ["argument", "mode"], ["value", "hand"]],
    ]
    unused, command = sorted(page.topics, key=lambda each: each.external)
    assert (unused.name, unused.when) == ("/unused", ["=", ["argument", "mode"], ["value", "hand"]])
    assert (command.type, command.description) == ("geometry_msgs.Twist", "From the operator")


def test_parameters_keep_kinds_and_what_is_looked_up(courier: Courier) -> None:
    """An integer stays one, a list is a list, and a look-up has the text that stands for it."""
    page = build(*courier)
    assert dict(_program(page, "lidar").parameters) == {
        "frame": ["text", ["argument", "robot"], "_laser"],
        "hosts": ["list", ["argument", "robot"], ["lookup", "env HOST, here"]],
    }
    assert dict(_program(page, "drive").parameters) == {
        "limit": ["*", ["argument", "speed"], ["argument", "times"]]
    }
    assert [(each.key, each.usual) for each in page.lookups] == [("env HOST, here", "here")]
    speed, times = page.arguments[-2:]
    assert (speed.default, speed.unit, speed.limits) == ({"double": "0.5"}, "m/s", "in [0.1, 2.0)")
    assert (times.type, times.default) == ("integer", {"int": "2"})


def test_ports_have_type_qos_units_and_place(courier: Courier) -> None:
    """What is not stated has the value that ROS 2 has for it."""
    page = build(*courier)
    (scan,) = _program(page, "lidar").ports
    assert (scan.kind, scan.channel, scan.feeds) == ("publisher", "topic", True)
    assert (scan.qos, scan.units) == ("best_effort, volatile, depth 5", ("ranges [m]",))
    assert not scan.wired
    of_map, read, save = _program(page, "slam").ports
    assert of_map.qos == "reliable, transient_local, depth 1"
    assert (read.wired, read.place) == (True, Place("courier.system", 28))
    assert (save.channel, save.feeds, save.qos) == ("service", False, "")


def test_findings_stand_at_the_smallest_part_that_they_are_in(courier: Courier) -> None:
    """One at a connection is about its port, one at a name about the node, one at a topic about it.

    A finding that stood everywhere, or nowhere, would show nothing.
    """
    page = build(*courier)
    codes = [each.code for each in page.findings]
    assert codes == [each.code.name for each in courier[1]]
    slam, drive = _program(page, "slam"), _program(page, "drive")
    assert [codes[each] for each in slam.ports[1].findings] == ["DRS205"]
    assert [codes[each] for each in drive.ports[2].findings] == ["DRS225"]
    assert {codes[each] for each in slam.findings} == {"DRS213", "DRS245"}
    (unused,) = (each for each in page.topics if each.name == "/unused")
    assert [codes[each] for each in unused.findings] == ["DRS212"]
    assert all(not each.findings for each in page.groups)


def test_finding_of_a_variant_has_its_values(courier: Courier) -> None:
    """The page can set them; one of all variants has none."""
    page = build(*courier)
    where = {each.code: each.where for each in page.findings}
    assert where["DRS225"] == (("slam", False),)
    assert where["DRS205"] == (("slam", True), ("mode", "auto"))
    assert where["DRS212"] == ()


def test_findings_in_a_description_are_about_all_nodes_of_the_type(
    tmp_path: Path,
) -> None:
    """A port that is described wrongly is wrong wherever it is used."""
    (tmp_path / "talker.rnd").write_text("node talker : p publishes topic out : no_msgs.Nothing")
    text = 'system S imports import "talker.rnd" topics external topic /out '
    (tmp_path / "s.system").write_text(text + "node one : talker node two : talker")
    loaded, findings = check_one(str(tmp_path / "s.system"), ())
    assert isinstance(loaded.model, System)
    page = build(loaded.model, findings)
    there = tuple(n for n, each in enumerate(findings) if each.span.file.endswith("talker.rnd"))
    about = [(*each.findings, *each.ports[0].findings) for each in page.programs]
    assert [sorted(each) for each in about] == [list(there)] * 2
    assert page.programs[0].ports[0].findings


def test_used_systems_and_groups_are_nested(tmp_path: Path) -> None:
    """A system that is used twice has its groups, and its values, at both places."""
    arm = 'system Arm "An arm" argument side : string = "none" imports import "grip.rnd"'
    (tmp_path / "arm.system").write_text(f"{arm} subsystem hand {{ node grip : grip }}")
    text = """
        system S imports import "arm.system"
        subsystem left : Arm(side = "left") namespace /left "The left one"
        subsystem right : Arm namespace /right
    """
    grip = "node grip : p publishes topic out : std_msgs.Bool"
    page = build(load_text(tmp_path, text, grip=grip), [])
    assert [each.path for each in page.groups] == [
        ("left",),
        ("left", "hand"),
        ("right",),
        ("right", "hand"),
    ]
    assert [(each.system, each.description) for each in page.groups[::2]] == [
        ("Arm", "The left one"),
        ("Arm", "An arm"),
    ]
    assert [each.full_name for each in page.programs] == ["/left/grip", "/right/grip"]


def test_nodes_in_a_process_say_so(tmp_path: Path) -> None:
    """They are shown where their conditions and that of the program hold."""
    text = """
        system S imports import "part.rnd" argument on : bool = true
        node host : part when on
        inside host { node first : part node second : part "Of two" }
    """
    page = build(load_text(tmp_path, text, part='node part : p executable "part_node"'), [])
    assert [each.description for each in page.programs] == [
        "",
        "In the process of host",
        "In the process of host: Of two",
    ]
    assert [each.executable for each in page.programs] == ["part_node", "", ""]
    assert [each.when for each in page.programs] == [["holds", ["argument", "on"]]] * 3


def test_programs_say_which_host_they_are_on(tmp_path: Path) -> None:
    """Nodes, processes and nodes in their processes."""
    text = """
        system S imports import "part.rnd" host robot "10.0.0.1" host desk "desk"
        subsystem base on robot { node wheels : part inside wheels { node left : part } }
        process viewer : "rviz2" on desk
    """
    page = build(load_text(tmp_path, text, part="node part : p"), [])
    assert {each.name: each.host for each in page.programs} == {
        "wheels": "robot",
        "left": "robot",
        "viewer": "desk",
    }


def test_system_whose_arguments_have_faults_is_shown_with_usual_values(tmp_path: Path) -> None:
    """There is no telling what else it may be; the page says so, and has no switches."""
    talker = "node talker : p parameters name n : int = 1 publishes topic out : std_msgs.Bool"
    text = """
        system S argument n : int = 0 imports import "talker.rnd"
        node talker : talker when 1 / 0 > n parameters param n = 2
        node other : talker parameters param n = 1 / 0
    """
    (tmp_path / "talker.rnd").write_text(talker)
    (tmp_path / "s.system").write_text(text)
    loaded, _ = check_one(str(tmp_path / "s.system"), ())
    assert isinstance(loaded.model, System)
    page = build(loaded.model, [])
    assert page.note == FAULTY_ARGUMENTS
    assert page.arguments == ()
    assert [each.name for each in page.programs] == ["other"]


@pytest.mark.parametrize("name", [each for each in all_cases() if each.endswith(".system")])
def test_no_fault_of_a_model_stops_the_page(name: str, monkeypatch: pytest.MonkeyPatch) -> None:
    """A page of a system with errors is what the findings in red are for."""
    monkeypatch.chdir(DIRECTORY)
    loaded, findings = check_one(name, [interfaces(name)])
    if isinstance(loaded.model, System):
        page = build(loaded.model, findings)
        assert len(page.findings) == len(findings)
        assert json.loads(json.dumps(asdict(page)))["name"] == loaded.model.name


def test_contents_are_the_same_each_time_and_plain_data(courier: Courier) -> None:
    """Nothing depends on an order of a set, and JSON can say all of it."""
    first, second = (json.dumps(asdict(build(*courier))) for _ in range(2))
    assert first == second
    assert json.loads(first)["name"] == "Courier"
