"""Every text and every substitution survives the grammar of the frontends."""

from __future__ import annotations

import functools
import json
import os
import random
import subprocess
from collections.abc import Mapping
from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st

from deros.generators.system.frontends.grammar import escaped, template
from deros.generators.system.launch.terms import Substitution, Terms
from tests.support.frontends import Frontend, NotReadableError

PYTHON = os.environ.get("DEROS_REAL_PYTHON", "")
REPOSITORY = Path(__file__).resolve().parents[4]
VALUES: Mapping[str, str] = {"plain": "x", "odd": "a b'\"\\$(var plain)", "n": "5", "is": "true"}

letters = st.sampled_from([*"ab \\'\"$()#:,\n\t/", "$(", "\\$(", "\\\\", "☃", "\x01", "$(var n)"])
texts = st.lists(letters, max_size=6).map("".join)


def _call(name: str, *operands: st.SearchStrategy[Terms]) -> st.SearchStrategy[Substitution]:
    return st.tuples(*operands).map(functools.partial(Substitution, name))


def _just(text: str) -> st.SearchStrategy[Terms]:
    return st.just((text,))


truths = st.one_of(
    _call("LaunchConfiguration", _just("is")),
    st.sampled_from(["5 > 2", "5 in (1, 2)", "not 5 and 2"]).flatmap(
        lambda text: _call("PythonExpression", _just(text))
    ),
)
leaves = st.one_of(
    st.sampled_from(["plain", "odd", "n"]).flatmap(
        lambda name: _call("LaunchConfiguration", _just(name))
    ),
    texts.flatmap(lambda text: _call("PythonExpression", _just(repr(text)))),
)


def _inner(inside: st.SearchStrategy[Terms]) -> st.SearchStrategy[Terms]:
    compared = st.sampled_from(["EqualsSubstitution", "NotEqualsSubstitution"]).flatmap(
        lambda name: _call(name, inside, inside)
    )
    chosen = _call("IfElseSubstitution", truths.map(lambda e: (e,)), inside, inside)
    known = _call("EnvironmentVariable", _just("SURELY_NOT_SET"), inside)
    joined = st.sampled_from(["AllSubstitution", "AnySubstitution"]).flatmap(
        lambda name: st.lists(truths.map(lambda e: (e,)), min_size=2, max_size=4).map(
            lambda found: Substitution(name, tuple(found))
        )
    )
    one = st.one_of(texts, chosen, known, compared, joined, leaves)
    return st.lists(one, max_size=3).map(tuple)


terms = st.recursive(
    st.lists(st.one_of(texts, leaves), max_size=3).map(tuple), _inner, max_leaves=6
)


def expected(found: Terms) -> str:
    """Return what terms become, after what launch says of their classes."""
    return "".join(each if isinstance(each, str) else _expected(each) for each in found)


def _expected(found: Substitution) -> str:
    operands = [expected(each) for each in found.operands]
    match found.name:
        case "LaunchConfiguration":
            return VALUES[operands[0]]
        case "PythonExpression":
            return str(eval(operands[0]))
        case "IfElseSubstitution":
            return operands[1] if operands[0].lower() == "true" else operands[2]
        case "EnvironmentVariable":
            return operands[1]
        case "AllSubstitution" | "AnySubstitution":
            every = all if found.name == "AllSubstitution" else any
            return str(every(each.lower() == "true" for each in operands)).lower()
    return str((operands[0] == operands[1]) == (found.name == "EqualsSubstitution")).lower()


def _is_clear(found: Terms) -> bool:
    """Return whether launch compares texts only, and no two that look like numbers."""
    return all(
        isinstance(each, str)
        or (
            all(map(_is_clear, each.operands))
            and ("Equals" not in each.name or not _are_alike(each))
        )
        for each in found
    )


def _are_alike(found: Substitution) -> bool:
    one, other = (expected(each).strip().lower() for each in found.operands)
    return one != other and all(e in ("5", "true", "false") for e in (one, other))


@given(found=terms.filter(_is_clear))
def test_texts_and_substitutions_are_read_as_they_are_meant(found: Terms) -> None:
    """The grammar has one way to read them."""
    assert Frontend(VALUES).performed(template(found)) == expected(found)


@pytest.mark.skipif(not PYTHON, reason="DEROS_REAL_PYTHON names no Python that has launch_ros")
def test_launch_reads_them_so() -> None:
    """The real grammar becomes the same texts."""
    found: list[Terms] = []

    @given(each=terms.filter(_is_clear))
    def draw(each: Terms) -> None:
        found.append(each)

    draw()
    chosen = random.Random(5).sample(found, min(len(found), 300))
    run = subprocess.run(
        [PYTHON, "-m", "tests.support.frontends"],
        input=json.dumps([dict(VALUES), [template(each) for each in chosen]]),
        cwd=REPOSITORY,
        capture_output=True,
        text=True,
        timeout=300,
        check=False,
    )
    assert run.returncode == 0, run.stderr
    assert json.loads(run.stdout) == [expected(each) for each in chosen]


@pytest.mark.parametrize(
    "text",
    [
        "\\\\$(var plain)",  # the backslash, or the substitution, is escaped
        "$(equals 'a\\\\' 'b c')",
        "$(eval \"'$(env NOT_SET 'a b')'\")",
        "$(if true a )",
        "$(var (plain))",
        "$(equals $(var plain) '')",
    ],
)
def test_reader_for_tests_refuses_what_launch_reads_otherwise(text: str) -> None:
    """The test above would miss a text that launch reads in another way."""
    with pytest.raises(NotReadableError):
        Frontend(VALUES).performed(text)


def test_spellings_are_those_of_hand_written_files() -> None:
    """Quotes and escapes stand only where they are needed."""
    name = Substitution("LaunchConfiguration", (("mode",),))
    number = Substitution("LaunchConfiguration", (("n",),))
    assert template((name, "_link")) == "$(var mode)_link"
    assert template(("a (b) 'c' $5",)) == "a (b) 'c' $5"
    assert template((Substitution("EqualsSubstitution", ((name,), ("a b",))),)) == (
        "$(equals $(var mode) 'a b')"
    )
    more = Substitution("PythonExpression", ((number, " + 1"),))
    assert template((more,)) == "$(eval $(var n)+1)"
    text = Substitution("PythonExpression", (("'", name, "' + 'x'"),))
    assert template((text,)) == "$(eval \"'$(var mode)' + 'x'\")"


def test_names_and_choices_have_escapes_only() -> None:
    """Launch looks for no substitutions in them."""
    assert escaped("a\\b$(c)") == "a\\\\b$(c)"
