"""Which program another one waits for, in a system whose subsystems nest."""

from __future__ import annotations

from pathlib import Path

from deros.systems.flatten import flatten
from deros.systems.running.starting import awaited_programs, key_of, programs_by_key
from tests.support.systems import load_text


def test_innermost_program_of_the_name_is_found(tmp_path: Path) -> None:
    """In the subsystem, or else in the next one around it; a path leads further in."""
    flat = flatten(
        load_text(
            tmp_path,
            """system s imports import "*.rnd"
            process x : "x"
            subsystem left { node x : a namespace /far subsystem deep { process y : "y" } }
            subsystem right { process y : "y" }
            """,
            a="node a : p",
        )
    )
    known = programs_by_key(flat)

    def found(path: tuple[str, ...], name: str) -> list[tuple[str, ...]]:
        return [key_of(each) for each in awaited_programs(path, name, known)]

    assert found((), "x") == found(("right",), "x") == [("x",)]
    assert found(("left",), "x") == found(("left", "deep"), "x") == [("left", "x")]
    assert found(("left",), "deep/y") == found(("right",), "left/deep/y") == [("left", "deep", "y")]
    assert found(("left",), "y") == found((), "y") == []


def test_nodes_of_one_name_are_all_found(tmp_path: Path) -> None:
    """Their namespaces tell them apart in the graph, and not here: the check reports that."""
    flat = flatten(
        load_text(
            tmp_path,
            'system s imports import "*.rnd" node x : a namespace /a node x : a namespace /b',
            a="node a : p",
        )
    )
    assert len(awaited_programs((), "x", programs_by_key(flat))) == 2
