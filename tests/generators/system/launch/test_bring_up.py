"""Launch files that bring managed nodes up: what they ask for when, and what follows a failure."""

from __future__ import annotations

from pathlib import Path

from deros.generators.builtin import rossystem_launch
from deros.generators.output.writer import write
from tests.support.launch_events import Launched, launched
from tests.support.lint import assert_lint_clean
from tests.support.systems import CONTEXT, load_text

UP = ("configure", "activate")


def text_of(folder: Path, system: str) -> str:
    """Return the launch file of a system of managed nodes."""
    model = load_text(folder, system, member="node member : crew lifecycle")
    (file,) = rossystem_launch(model, CONTEXT).values()
    return file.text


def run(folder: Path, body: str, **values: str) -> Launched:
    """Launch a system, whose processes start."""
    text = text_of(folder, f'system s autostart imports import "*.rnd" {body}')
    found = launched(text, **values)
    for name in found.nodes:
        found.started(name)
    return found


def test_each_node_is_configured_when_the_one_before_is_active(tmp_path: Path) -> None:
    """The order is that of the text, across subsystems."""
    found = run(tmp_path, "node a : member subsystem s namespace /n { node b : member }")
    assert found.requests == [("/a", "configure")]
    found.changed("/a", "unconfigured", "configuring")
    assert found.requests == [("/a", "configure")]
    found.changed("/a", "configuring", "inactive")
    assert found.requests == [("/a", "configure"), ("/a", "activate")]
    found.changed("/a", "activating", "active")
    assert found.requests[2:] == [("/n/b", "configure")]
    found.comes_up("/n/b")
    assert found.requests[3:] == [("/n/b", "activate")]
    assert found.logged == ["2 of 2 managed nodes are active"]
    assert all(timer.is_canceled for timer in found.timers)
    assert found.reasons == []


def test_failed_transition_stops_everything(tmp_path: Path) -> None:
    """Nothing is asked of the nodes after it."""
    found = run(tmp_path, "node a : member node b : member")
    found.changed("/a", "configuring", "errorprocessing")
    assert found.reasons == ["/a is not active: it is errorprocessing after configuring"]
    assert found.requests == [("/a", "configure")]


def test_transition_that_takes_too_long_stops_everything(tmp_path: Path) -> None:
    """The timeout is that of the node, which it has for each transition."""
    found = run(tmp_path, "node a : member autostart timeout 1500 ms node b : member")
    found.changed("/a", "configuring", "inactive")
    assert [timer.period for timer in found.timers] == [1.5, 1.5]
    found.expire(1.5)
    assert found.reasons == ["/a is not active: it does not activate in time"]


def test_others_come_up_without_an_optional_node(tmp_path: Path) -> None:
    """With ``on failure continue`` a failure, and an end, are logged alone."""
    optional = "member autostart on failure continue"
    found = run(tmp_path, f"node a : {optional} node b : {optional} node c : member")
    found.changed("/a", "configuring", "unconfigured")
    found.exited("/b")
    found.comes_up("/c")
    assert found.requests[1:] == [("/b", "configure"), *(("/c", each) for each in UP)]
    assert found.logged[:2] == [
        "/a is not active: it is unconfigured after configuring",
        "/b is not active: it has ended",
    ]
    assert found.logged[2:] == ["1 of 3 managed nodes are active"]
    assert found.reasons == []


def test_end_of_a_node_on_its_way_stops_everything(tmp_path: Path) -> None:
    """It does not wait for the timeout."""
    found = run(tmp_path, "node a : member node b : member")
    found.exited("/a")
    assert found.reasons == ["/a is not active: it has ended"]


def test_respawned_node_is_brought_up_again(tmp_path: Path) -> None:
    """It is asked again and again until its transition begins: its first self is in the graph."""
    found = run(tmp_path, "node a : member respawn node b : member")
    found.comes_up("/a")
    found.comes_up("/b")
    before = len(found.requests)
    found.exited("/a")
    assert found.requests[before:] == []
    found.started("/a")
    found.expire(2.0)
    assert found.requests[before:] == [("/a", "configure")] * 2
    found.changed("/a", "unconfigured", "configuring")
    found.expire(2.0)
    assert found.requests[before:] == [("/a", "configure")] * 2
    found.changed("/a", "configuring", "inactive")
    found.changed("/a", "activating", "active")
    assert found.requests[before + 2 :] == [("/a", "activate")]
    assert found.logged == ["2 of 2 managed nodes are active"] * 2
    assert found.reasons == []


def test_node_that_dies_while_it_configures_is_awaited_where_it_respawns(tmp_path: Path) -> None:
    """The next node waits, too, and the timeout does not run meanwhile."""
    found = run(tmp_path, "node a : member respawn node b : member")
    found.exited("/a")
    found.expire(10.0)
    assert (found.requests, found.reasons) == ([("/a", "configure")], [])
    found.started("/a")
    found.comes_up("/a")
    assert found.requests[1:] == [*(("/a", each) for each in UP), ("/b", "configure")]


def test_nodes_that_are_left_out_are_not_awaited(tmp_path: Path) -> None:
    """A condition that does not hold takes a node out of the order."""
    body = "argument deep : bool = true node a : member when deep node b : member"
    assert run(tmp_path, body, deep="true").requests == [("/a", "configure")]
    assert run(tmp_path, body, deep="false").requests == [("/b", "configure")]


def test_only_systems_with_autostart_have_any_of_it(tmp_path: Path) -> None:
    """A managed node that another one activates is started as before."""
    text = text_of(
        tmp_path,
        'system s autostart imports import "*.rnd" node a : member activated by b node b : member',
    )
    assert text.count("managed.add(") == 1
    text = text_of(tmp_path, 'system s imports import "*.rnd" node a : member')
    assert "BringUp" not in text
    assert "lifecycle_msgs" not in text


def test_launch_file_passes_the_ament_linters(tmp_path: Path) -> None:
    """flake8 and pep257 with ament's settings find nothing."""
    body = "node a : member respawn node b : member autostart on failure continue"
    model = load_text(
        tmp_path,
        f'system s autostart imports import "*.rnd" {body}',
        member="node member : crew lifecycle",
    )
    write(rossystem_launch(model, CONTEXT), tmp_path / "out")
    assert_lint_clean(tmp_path / "out")
