"""Launch files of systems in which programs are started later, or stop all when they end."""

from __future__ import annotations

from pathlib import Path

import pytest

from deros.generators.builtin import rossystem_launch
from deros.generators.output.writer import write
from tests.support.launch_events import ComposableNodeContainer, Launched, launched_with
from tests.support.lint import assert_lint_clean
from tests.support.systems import CONTEXT, load_text

WHOLE = """system s
argument fast : bool = true
argument word : string = "w"
imports import "*.rnd"
process first : "first"
process next : "next" arguments [$word] after exit of first delay 2 sec when fast
subsystem inner {
  process first : "other" when not fast
  process last : "last" after exit of first
}
process late : "late" delay 1500 ms on exit stop all
"""


def text_of(folder: Path, system: str) -> str:
    """Return the launch file of a system."""
    model = load_text(folder, system, member="node member : crew lifecycle")
    (file,) = rossystem_launch(model, CONTEXT).values()
    return file.text


def run(folder: Path, system: str = WHOLE, **values: str) -> Launched:
    """Launch a system."""
    given = {"fast": "true", "word": "moin", **values}
    return launched_with(text_of(folder, system), {"A": "b"}, **given)


def test_programs_are_started_when_their_time_has_come(tmp_path: Path) -> None:
    """At an exit, at a moment, or at a moment after an exit."""
    found = run(tmp_path)
    assert list(found.nodes) == ["first"]
    found.expire(1.5)
    assert list(found.nodes) == ["first", "late"]
    found.exited("first")
    assert list(found.nodes) == ["first", "late", "last"]
    found.expire(2.0)
    assert list(found.nodes) == ["first", "late", "last", "next"]


def test_scope_of_a_group_is_put_back(tmp_path: Path) -> None:
    """The arguments, variables and folder are those where the program stands."""
    found = run(tmp_path)
    found.exited("first")
    found.leave_scope()
    found.expire(2.0)
    assert found.seen["next"] == ({"fast": "true", "word": "moin"}, {"A": "b"})
    assert found.locals == {"current_launch_file_directory": "/"}
    found.expire(1.5)  # what was put back for the one before is not left behind
    assert found.nodes["late"].on_exit.reason == "late has ended"


def test_conditions_decide_what_waits_for_what(tmp_path: Path) -> None:
    """What is left out is not started; an inner program of the name, if it is there, is awaited."""
    found = run(tmp_path, fast="false")
    outer, inner = (each for each in found.started_ones if each.name == "first")
    found.exited_one(outer)
    found.expire(2.0)
    assert list(found.nodes) == ["first"]
    found.exited_one(inner)
    assert list(found.nodes) == ["first", "last"]


def test_nothing_is_started_once_all_is_stopped(tmp_path: Path) -> None:
    """Neither by an exit nor by a timer."""
    found = run(tmp_path)
    found.reasons.append("stopped")
    found.exited("first")
    found.expire(1.5)
    assert list(found.nodes) == ["first"]
    assert [each.period for each in found.timers] == [1.5]


def test_container_is_started_later_with_what_is_loaded(tmp_path: Path) -> None:
    """It is one program like any other, also for those that wait for it."""
    (tmp_path / "part.rnd").write_text('node part : parts plugin "parts::Part"')
    system = """system s imports import "*.rnd"
        process first : "first"
        container box after exit of first delay 3 sec on exit stop all { node a : part }
        process last : "last" after exit of box"""
    found = run(tmp_path, system)
    found.exited("first")
    assert list(found.nodes) == ["first"]
    found.expire(3.0)
    assert list(found.nodes) == ["first", "/box"]
    box = found.nodes["/box"]
    assert isinstance(box, ComposableNodeContainer)
    assert [each.name for each in box.composable_node_descriptions] == ["a"]
    assert box.on_exit.reason == "box has ended"
    found.exited("/box")
    assert list(found.nodes) == ["first", "/box", "last"]


def test_managed_node_that_is_started_later_does_not_hold_up_the_others(tmp_path: Path) -> None:
    """It is brought up when it has started; only a later start of it is one more."""
    system = """system s autostart imports import "*.rnd"
        node first : member delay 3 sec respawn
        node second : member"""
    found = run(tmp_path, system)
    found.started("/second")
    found.comes_up("/second")
    assert found.requests == [("/second", "configure"), ("/second", "activate")]
    assert found.logged == ["1 of 2 managed nodes are active"]
    found.expire(3.0)
    assert found.requests[2:] == []
    found.started("/first")
    assert found.requests[2:] == [("/first", "configure")]
    found.comes_up("/first")
    assert found.logged[1:] == ["2 of 2 managed nodes are active"]
    assert len([each for each in found.timers if each.period == 2.0]) == 0  # it is not asked again


@pytest.mark.parametrize("body", ['process a : "a"', "node a : member"])
def test_only_systems_with_later_starts_have_any_of_it(tmp_path: Path, body: str) -> None:
    """Not those whose programs all start together, nor those that only stop all."""
    text = text_of(tmp_path, f'system s imports import "*.rnd" {body} on exit stop all')
    assert "Starts" not in text
    assert "TimerAction" not in text
    assert "on_exit=Shutdown(reason='a has ended')" in text


def test_launch_file_passes_the_ament_linters(tmp_path: Path) -> None:
    """With managed nodes, conditions and arguments."""
    body = "subsystem crew autostart { node last : member after exit of first delay 1 sec }"
    model = load_text(tmp_path, WHOLE + body, member="node member : crew lifecycle")
    write(rossystem_launch(model, CONTEXT), tmp_path / "out")
    assert_lint_clean(tmp_path / "out")
