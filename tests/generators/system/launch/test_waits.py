"""Launch files of systems in which programs wait for what is in the ROS graph."""

from __future__ import annotations

from pathlib import Path

import pytest

from deros.generators.builtin import rossystem_launch
from deros.generators.output.writer import write
from tests.support.launch_events import Launched, launched_with
from tests.support.lint import assert_lint_clean
from tests.support.systems import CONTEXT, load_text

WAITS = ("node first", "service /go", "topic /out", "active first")


def text_of(folder: Path, body: str) -> str:
    """Return the launch file of a system."""
    model = load_text(
        folder, f'system s imports import "*.rnd" {body}', member="node member : crew lifecycle"
    )
    (file,) = rossystem_launch(model, CONTEXT).values()
    return file.text


def run(folder: Path, body: str, **values: str) -> Launched:
    """Launch a system."""
    return launched_with(text_of(folder, body), {}, **values)


def names(found: Launched) -> list[str]:
    """Return what has been started."""
    return list(found.nodes)


def comes(found: Launched, wait: str) -> None:
    """Let what is waited for be there."""
    kind, name = wait.split()
    if kind == "node":
        found.graph.nodes.append(("first", "/"))
    elif kind == "service":
        found.graph.services.append(name)
    elif kind == "topic":
        found.graph.publishers.append(name)
    else:
        found.graph.states["/first"] = 3


@pytest.mark.parametrize("wait", WAITS)
def test_program_is_started_when_it_is_there(tmp_path: Path, wait: str) -> None:
    """Looks again and again, and starts it once."""
    found = run(tmp_path, f'node first : member process next : "n" after {wait}')
    assert names(found) == ["/first"]
    found.expire(0.1)
    assert names(found) == ["/first"]
    comes(found, wait)
    found.expire(0.1)  # of a managed node, it asks for the state
    found.expire(0.1)
    assert names(found) == ["/first", "next"]
    assert all(each.is_canceled for each in found.timers)
    assert found.reasons == []


def test_delay_begins_when_it_is_there(tmp_path: Path) -> None:
    """It is a timer of its own."""
    found = run(tmp_path, 'process next : "n" after service /go delay 2 sec')
    comes(found, "service /go")
    found.expire(0.1)
    assert names(found) == []
    found.expire(2.0)
    assert names(found) == ["next"]


def test_what_never_comes_stops_everything(tmp_path: Path) -> None:
    """With the reason; nothing is looked at any more."""
    found = run(tmp_path, 'process next : "n" after service /go timeout 3 sec')
    found.expire(3.0)
    reason = "next is not started: it waits for service /go, and it is not there within 3 s"
    assert (found.logged, found.reasons) == ([reason], [reason])
    comes(found, "service /go")
    found.expire(0.1)
    assert names(found) == []


def test_node_that_ends_before_it_is_there_is_not_waited_for(tmp_path: Path) -> None:
    """Unless it is started again when it ends."""
    text = 'node first : member %s process next : "n" after node first'
    found = run(tmp_path, text % "")
    found.exited("/first")
    assert found.reasons == [
        "next is not started: it waits for node /first, and first is not running any more"
    ]
    (tmp_path / "again").mkdir()
    found = run(tmp_path / "again", text % "respawn")
    found.exited("/first")
    assert found.reasons == []
    comes(found, "node first")
    found.expire(0.1)
    assert names(found) == ["/first", "next"]


def test_end_of_a_node_that_was_there_is_no_matter(tmp_path: Path) -> None:
    """What waited has been started."""
    found = run(tmp_path, 'node first : member process next : "n" after node first')
    comes(found, "node first")
    found.expire(0.1)
    found.exited("/first")
    assert found.reasons == []


def test_time_begins_with_the_start_of_a_node_that_is_started_later(tmp_path: Path) -> None:
    """Before that, nothing is looked at."""
    found = run(
        tmp_path,
        'node first : member delay 9 sec process next : "n" after node first timeout 3 sec',
    )
    assert [each.period for each in found.timers] == [9.0]
    found.expire(9.0)
    found.started("/first")
    assert [each.period for each in found.timers] == [9.0, 3.0, 0.1]
    found.expire(3.0)
    assert len(found.reasons) == 1


def test_conditions_decide_which_node_is_waited_for(tmp_path: Path) -> None:
    """By its name, and by the end of its process."""
    body = """argument far : bool = false
    node first : member namespace /a when far node first : member namespace /b when not far
    process next : "n" after node first"""
    for value, space in (("true", "/a"), ("false", "/b")):
        (tmp_path / value).mkdir()
        found = run(tmp_path / value, body, far=value)
        other = "/b" if space == "/a" else "/a"
        found.graph.nodes.append(("first", other))
        found.expire(0.1)
        assert "next" not in found.nodes
        found.graph.nodes.append(("first", space))
        found.expire(0.1)
        assert "next" in found.nodes


def test_name_is_below_the_namespace_that_the_file_is_included_in(tmp_path: Path) -> None:
    """As that of the node is; an absolute one is not, be it so by its value."""
    body = 'argument end : string = "go" process next : "n" after service $end'
    for value, name in (("go", "/robot/go"), ("/go", "/go")):
        (tmp_path / value.strip("/") / name[1:]).mkdir(parents=True)
        found = run(tmp_path / value.strip("/") / name[1:], body, end=value, ros_namespace="/robot")
        found.graph.services.append(name)
        found.expire(0.1)
        assert names(found) == ["next"]


def test_nothing_is_started_once_all_is_stopped(tmp_path: Path) -> None:
    """Nor is anything said of it."""
    found = run(tmp_path, 'process next : "n" after service /go timeout 3 sec')
    found.reasons.append("stopped")
    comes(found, "service /go")
    found.expire(0.1)
    found.expire(3.0)
    assert (names(found), found.logged) == ([], [])


def test_only_what_is_waited_for_is_in_the_file(tmp_path: Path) -> None:
    """No class for waiting in a file without it, and no more of it than is used."""
    assert "GraphWait" not in text_of(tmp_path, 'process a : "a" delay 1 sec')
    text = text_of(tmp_path, 'process a : "a" after service /go')
    assert "count_services" in text
    assert not [each for each in ("GetState", "count_publishers", "get_node_names") if each in text]


@pytest.mark.parametrize("wait", [*WAITS, ""])
def test_launch_file_passes_the_ament_linters(tmp_path: Path, wait: str) -> None:
    """With each kind alone, and with all."""
    body = "node first : member autostart "
    body += " ".join(
        f'process next{number} : "n" after {each}'
        for number, each in enumerate([wait] if wait else WAITS)
    )
    model = load_text(
        tmp_path, f'system s imports import "*.rnd" {body}', member="node member : crew lifecycle"
    )
    write(rossystem_launch(model, CONTEXT), tmp_path / "out")
    assert_lint_clean(tmp_path / "out")
