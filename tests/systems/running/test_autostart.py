"""Which nodes are brought up at the start, and what counts where several things are written."""

from __future__ import annotations

from pathlib import Path

from deros.systems.arguments.resolve import resolve
from deros.systems.flatten import flatten
from tests.support.systems import load_text

NODES = {"managed": "node managed : demo lifecycle", "plain": "node plain : demo"}


def brought_up(folder: Path, text: str, **values: bool) -> dict[str, tuple[float, bool]]:
    """Return timeout and whether it is optional of each node that is brought up, in order."""
    system = load_text(folder, text.replace("imports", 'imports import "*.rnd"'), **NODES)
    return {
        node.full_name: (node.autostart.timeout_s, node.autostart.is_optional)
        for node in flatten(resolve(system, values)).nodes
        if node.autostart is not None
    }


def test_all_managed_nodes_below_are_brought_up_in_the_order_written(tmp_path: Path) -> None:
    """Neither those that are not managed, nor those that another node activates."""
    text = """system S autostart imports
        node a : managed node p : plain
        subsystem s namespace /s { node b : managed subsystem t { node c : managed } }
        node d : managed activated by a
        node e : managed"""
    assert list(brought_up(tmp_path, text)) == ["/a", "/s/b", "/s/c", "/e"]


def test_what_stands_further_inside_counts(tmp_path: Path) -> None:
    """Each of the two settings by itself."""
    text = """system S autostart timeout 1 sec imports
        node a : managed
        subsystem s autostart on failure continue {
          node b : managed
          node c : managed autostart timeout 3 sec
          node d : managed autostart on failure stop
        }"""
    assert brought_up(tmp_path, text) == {
        "/a": (1.0, False),
        "/b": (1.0, True),
        "/c": (3.0, True),
        "/d": (1.0, False),
    }


def test_nothing_is_brought_up_outside(tmp_path: Path) -> None:
    """A subsystem says nothing about its neighbours."""
    text = "system S imports subsystem s autostart { node a : managed } node b : managed"
    assert list(brought_up(tmp_path, text)) == ["/a"]


def test_used_system_counts_before_its_user(tmp_path: Path) -> None:
    """What the imported system says of itself is further inside than where it is used."""
    (tmp_path / "arm.system").write_text(
        'system Arm autostart timeout 2 sec imports import "*.rnd" node n : managed'
    )
    (tmp_path / "leg.system").write_text('system Leg imports import "*.rnd" node n : managed')
    text = """system S imports import "arm.system" import "leg.system"
        subsystem l : Arm namespace /l
        subsystem r : Arm namespace /r autostart timeout 9 sec on failure continue
        subsystem x : Leg namespace /x autostart timeout 9 sec
        subsystem y : Leg namespace /y"""
    assert brought_up(tmp_path, text) == {
        "/l/n": (2.0, False),
        "/r/n": (2.0, True),
        "/x/n": (9.0, False),
    }


def test_condition_takes_a_node_out_of_the_order(tmp_path: Path) -> None:
    """The others are brought up as before."""
    text = """system S autostart imports argument deep : bool = true
        node a : managed when deep node b : managed"""
    assert list(brought_up(tmp_path, text, deep=True)) == ["/a", "/b"]
    assert list(brought_up(tmp_path, text, deep=False)) == ["/b"]
