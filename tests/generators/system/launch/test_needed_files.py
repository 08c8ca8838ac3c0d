"""Launch files look for each file once, whenever one of its programs is there."""

from __future__ import annotations

import itertools
from pathlib import Path

from hypothesis import given
from hypothesis import strategies as st

from deros.diagnostics import SourceFile, Span
from deros.generators.system.launch.needed_files import united
from deros.models.arguments import Argument, Compared, Condition, Holds, Joined, Literally, Not
from deros.systems.arguments.evaluate import holds
from tests.generators.system.test_arguments import launch_file
from tests.support.systems import load_text

SPAN = Span(SourceFile("s.system", "s"), 0, 0)
VALUES = {"a": (False, True), "b": (False, True), "m": ("x", "y", "z")}
ATOMS: tuple[Condition, ...] = (
    Holds(Argument("a", SPAN), SPAN),
    Holds(Argument("b", SPAN), SPAN),
    *(Compared("=", Argument("m", SPAN), Literally(each, SPAN), SPAN) for each in VALUES["m"]),
)
literals = st.sampled_from([*ATOMS, *(Not(each, SPAN) for each in ATOMS)])
conjunctions = st.lists(literals, max_size=3).map(
    lambda found: Joined("and", tuple(found), SPAN) if len(found) > 1 else (*found, None)[0]
)


def _holds(conditions: list[Condition | None], values: dict[str, bool | str]) -> bool:
    return any(each is None or holds(each, values) for each in conditions)


@given(st.lists(conjunctions, max_size=8))
def test_union_holds_where_one_of_the_conditions_does(conditions: list[Condition | None]) -> None:
    """For all values, and with no more conditions than before."""
    found = united(conditions)
    assert len(found) <= len(conditions)
    for chosen in itertools.product(*VALUES.values()):
        values = dict(zip(VALUES, chosen, strict=True))
        assert _holds(found, values) == _holds(conditions, values), found


def test_forms_of_a_node_are_one_condition_again() -> None:
    """What splits a node into forms does not decide about its file."""
    a, b, *_ = ATOMS
    forms = [Joined("and", pair, SPAN) for pair in itertools.product((a, Not(a, SPAN)), (b,))]
    assert united(forms) == [b]
    assert united([*forms, Not(b, SPAN)]) == [None]
    assert united([]) == []


def test_file_is_looked_for_once(tmp_path: Path) -> None:
    """Whatever the number of nodes, of their forms, and of its statements."""
    (tmp_path / "x.yaml").write_text("/**: {ros__parameters: {rate: 1.0}}")
    system = load_text(
        tmp_path,
        """system s imports import "*.rnd"
        argument a : bool = true argument b : bool = true
        parameters from "x.yaml"
        node one : a respawn if a when b
        node two : a arguments ["-v" when a] when b
        node three : a when not b and a
        """,
        a="node a : p parameters name rate : double = 2.0",
    )
    text = launch_file(system)
    assert text.count("function=check_file") == 2
    alone = launch_file(load_text(tmp_path, 'system s imports import "*.rnd" node one : a'))
    assert "check_file" not in alone
