"""Whatever stands in a text beside the values of arguments, the script gives it to a program."""

from __future__ import annotations

from typing import Any

import pytest
from hypothesis import HealthCheck, example, given, settings
from hypothesis import strategies as st

from deros.generators.node.description import quoted_text
from deros.generators.system.script.generate import table
from deros.generators.system.view import system_view
from deros.models.common import Scalar
from deros.models.system import System
from deros.systems.arguments.lookups import looked_up
from deros.systems.arguments.resolve import resolve
from tests.generators.system.test_arguments import plain, script_of
from tests.support.arguments import text_of
from tests.support.systems import load_text

VALUES: dict[str, Scalar] = {"robot": "r'1\"", "k": 2, "up": True}
USES = ("${robot}", "${k}", "${env(A, it's)}")

TYPED = """node typed : lib executable "e" plugin "lib::Typed" parameters
  name a : string = "" name h : string[] = [""] name i : integer = 0 name d : double = 0.0
"""
OPEN = 'node open : lib executable "e" parameters open'
USED = """system Used argument given : string argument number : string imports import "typed.rnd"
node e : typed when number = "2" parameters param a = "${given}: ${number}"
"""

plain_texts = st.text(
    st.sampled_from("ab '\"\\{}$%#\n\té\U0001f916")
    | st.characters(codec="utf-8", exclude_categories=("Cc", "Cf")),
    max_size=8,
)


def written(text: str) -> str:
    """Return what stands between the quotes for a text without values in it."""
    return quoted_text(text, always=True)[1:-1].replace("${", "$${")


texts = st.lists(st.sampled_from(USES) | plain_texts.map(written), min_size=1, max_size=4).map(
    lambda pieces: f'"{"".join(pieces)}"'
)
texts |= st.sampled_from(["$robot", '"${robot}"', '"${k}"'])


def shown(row: Any) -> tuple[object, ...]:
    """Return what is started, with the types of all values."""
    parameters = plain(row.parameters) if hasattr(row, "parameters") else {}
    return row.name, parameters, list(row.arguments), dict(row.environment), row.prefix


def assert_started_as_modelled(system: System) -> None:
    """Compare the rows of the script with those that ``deros up`` runs."""
    script = script_of(system)
    start = script.Start(__file__)
    words = [f"{name}:={text_of(value)}" for name, value in VALUES.items()]
    found = script.nodes(script.given(script.ARGUMENTS, words, (start,)), start)
    values = {**VALUES, **looked_up(system, lambda each: start.env(each.name, each.default))}
    expected = table(system_view(resolve(system, values)))
    assert list(map(shown, found)) == list(map(shown, expected))


@settings(
    max_examples=25, deadline=None, suppress_health_check=[HealthCheck.function_scoped_fixture]
)
@given(found=st.lists(texts, min_size=7, max_size=7))
@example(
    found=[
        '"${robot}: it\'s a \\"robot\\""',
        '"${robot}: {\\\\\\"a\\\\\\": 1}"',
        '"$${robot}"',
        *['"x"'] * 4,
    ]
)
@example(found=['"${k}"'] * 7)
def test_texts_are_those_of_the_model(
    tmp_path_factory: pytest.TempPathFactory, found: list[str]
) -> None:
    """In parameters, lists, arguments and variables, in and out of containers."""
    one, two, three, four, argument, variable, passed = found
    folder = tmp_path_factory.mktemp("texts")
    (folder / "used.system").write_text(USED)
    system = load_text(
        folder,
        f"""system S
        argument robot : string
        argument k : int
        argument up : bool
        imports
          import "*.rnd"
          import "used.system"
        node a : typed arguments [{argument}, $k] env A = {variable} prefix "nice"
          parameters
            param a = {one}
            param h = [{two}, "x", $robot]
            param i = $k
            param d = $k
        node b : open
          parameters
            param a = {three}
            param h = [{four}, "${{k}}"]
            param i = [$k, 1]
            param chosen = if up then "${{k}}" else {three}
            param v = env("A", "")
        container c {{
          node loaded : typed parameters
            param a = {one}
            param h = [{two}, "${{k}}"]
        }}
        process tool : "tool" arguments [{argument}] env A = {variable}
        subsystem used : Used(given = {passed}, number = "${{k}}")
        """,
        typed=TYPED,
        open=OPEN,
    )
    assert_started_as_modelled(system)
