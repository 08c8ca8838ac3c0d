"""The code of small programs, one for each kind of construct, short enough to review.

Their contracts are reviewed in ``test_contracts.py``.
"""

from __future__ import annotations

import functools

import pytest

from deros.generators.api.protocol import File, Owner
from deros.generators.monitor.c.helpers import helper_names
from tests.support.c_everything import NAMES, everything, texts_of
from tests.support.c_shapes import shapes
from tests.support.c_snippets import SMALLEST_RULES, kind_of, shown, snippets, texts
from tests.support.golden import Golden


@pytest.mark.essential
def test_snippets_match_golden(golden: Golden) -> None:
    """The code of the smallest program, and what each construct adds to it."""
    files = {f"smallest.{end}": text for end, text in texts(SMALLEST_RULES).items()}
    files |= {f"{name}.c": text for name, text in snippets().items()}
    golden.check("monitor_c", {name: File(text, Owner.USER) for name, text in files.items()})


@functools.cache
def shapes_shown() -> set[tuple[str, str]]:
    """Return the shapes of all that is shown."""
    blocks = (block for each in shown().values() for block in each.values())
    return shapes("\n\n".join((*texts(SMALLEST_RULES).values(), *blocks)))


def code(program: str) -> str:
    """Return the header and the source of a named program."""
    files = texts_of(program).items()
    return "\n\n".join(text for name, text in files if "_contracts" not in name)


@pytest.mark.parametrize("name", NAMES)
def test_snippets_show_every_kind_of_code(name: str) -> None:
    """Whoever adds a construct, a function or a statement to the emitted C adds it here too."""
    unseen = shapes(code(name), name) - shapes_shown()
    assert unseen == set(), "show them in tests/data/constructs.md"


def test_snippets_show_every_helper() -> None:
    """Those too that no robot among the examples needs."""
    kinds = {kind_of(key) for each in shown().values() for key in each}
    assert {kind_of(each) for each in helper_names(everything())} <= kinds


BEGINS = "  m->started = true;"


@pytest.mark.parametrize(
    "added",
    [
        "  m->started = false;",
        "  restart(m, m->now);",
        "  flush(m);",
        "  if (m->due < m->now) {",
        "  m->body_tilted_since = m->due;",
        "  while (m->due < m->now) {",
        "}\n\nstatic void flush(everything_monitor *m)\n{",
    ],
)
def test_code_that_is_not_shown_is_found(added: str) -> None:
    """Each is a statement that functions of that kind do not have in any snippet."""
    text = code("everything")
    assert text.count(BEGINS) == 1
    changed = text.replace(BEGINS, f"{BEGINS}\n{added}")
    assert shapes(changed, "everything") - shapes_shown() != set()
