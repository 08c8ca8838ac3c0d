"""The contracts of small programs, one for each kind of construct, short enough to review.

That every function of a monitor has a contract, and that Frama-C reads and proves them, other tests
check on larger programs (``test_proof.py``, ``test_names.py``).
"""

from __future__ import annotations

import re
from dataclasses import replace

import pytest

from deros.generators.api.protocol import File, Owner
from deros.generators.monitor.c.interface import render_monitor
from tests.support.golden import Golden
from tests.support.rules import program
from tests.support.tables import rows

BLOCK = re.compile(
    r"(?:/\*(?!@)(?:(?!\*/).)*?\*/\n)?/\*@(?:(?!\*/).)*?\*/\n(?:\w[^;{}#/]*;\n)?", re.DOTALL
)
"""A comment, a predicate or a contract, and the function that has the contract."""

DEFINED = re.compile(r"(?:predicate|logic (?:integer|double|boolean)) (\w+)|(\w+)\([^()]*\);$")


STOP = "if e.r then { stop; };"
CONSTRUCTS = {each["construct"]: each for each in rows("constructs", "Contracts")}
"""Constructs by name: the rules, and the declarations that state their meaning."""


def contracts(rules: str) -> str:
    """Return the contracts of a program."""
    return render_monitor(replace(program(rules), name="small"))["small_contracts.h"]


def excerpt(text: str, names: tuple[str, ...]) -> str:
    """Return the declarations of these names with their contracts, in the order of the text.

    Raises:
        AssertionError: a name is not declared.
    """
    found: dict[str, str] = {}
    for block in BLOCK.findall(text):
        match = DEFINED.search(block.strip())
        if match is not None:
            found.setdefault(match[1] or match[2], block)
    missing = [name for name in names if name not in found]
    assert missing == [], sorted(found)
    return "\n".join(block for name, block in found.items() if name in names)


@pytest.mark.essential
def test_contracts_match_golden(golden: Golden) -> None:
    """The contracts of the smallest program, and those that state the meaning of a construct."""
    smallest = contracts("action stop; input b = topic /flag.data entity e { r: b; } " + STOP)
    files = {"smallest.h": smallest}
    for name, construct in CONSTRUCTS.items():
        rules = construct["rules"]
        declared = excerpt(contracts(rules), tuple(construct["declarations"].split()))
        files[f"{name}.h"] = f"/* {rules} */\n\n{declared}"
    golden.check(
        "monitor_c_contracts", {name: File(text, Owner.USER) for name, text in files.items()}
    )


def test_excerpt_names_missing_declarations() -> None:
    """A declaration that is renamed must not vanish from the review."""
    with pytest.raises(AssertionError):
        excerpt(contracts(CONSTRUCTS["comparison"]["rules"]), ("judged_nothing",))
