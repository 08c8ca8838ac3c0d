"""The contracts of small programs, one for each kind of construct, short enough to review.

That every function of a monitor has a contract, and that Frama-C reads and proves them, other tests
check on larger programs (``test_proof.py``, ``test_names.py``).
"""

from __future__ import annotations

import re
from dataclasses import dataclass, replace

import pytest

from deros.generators.api.protocol import File, Owner
from deros.generators.monitor.c.interface import render_monitor
from tests.support.golden import Golden
from tests.support.rules import program

BLOCK = re.compile(
    r"(?:/\*(?!@)(?:(?!\*/).)*?\*/\n)?/\*@(?:(?!\*/).)*?\*/\n(?:\w[^;{}#/]*;\n)?", re.DOTALL
)
"""A comment, a predicate or a contract, and the function that has the contract."""

DEFINED = re.compile(r"(?:predicate|logic (?:integer|double|boolean)) (\w+)|(\w+)\([^()]*\);$")


@dataclass(frozen=True)
class Construct:
    """A program with one construct, and the declarations that state its meaning.

    Attributes:
        rules: the program.
        declarations: predicates and functions whose contracts are reviewed.
    """

    rules: str
    declarations: tuple[str, ...]


STOP = "if e.r then { stop; };"
SPEED = "input v = topic /odom.twist.twist.linear.x"
CONSTRUCTS = {
    "comparison": Construct(
        f"action stop; {SPEED} entity e {{ r: v > 1.5; }} {STOP}",
        ("judged_e_r", "judge_e_r", "take_v"),
    ),
    "interval": Construct(
        f"action stop; {SPEED} entity e {{ r: v in [-1, 1) and not v = 0; }} {STOP}",
        ("judged_e_r",),
    ),
    "duration": Construct(
        f"action stop; {SPEED} entity e {{ r: v > 1.5 for 2 sec; }} {STOP}",
        ("judged_e_r", "intervals_run_on", "ends_in_time", "lasting", "earliest"),
    ),
    "timeout": Construct(
        f"action stop; {SPEED} timeout 0.5 sec entity e {{ r: v > 1 or v.missing(); }} {STOP}",
        ("judged_e_r", "timeouts_in_time", "expire_v", "forget_v"),
    ),
    "unknown": Construct(
        f"action stop; {SPEED} timeout 0.5 sec entity e {{ failsafe r: v > 1 or v.unknown(); }} "
        f"{STOP}",
        ("judged_e_r",),
    ),
    "text": Construct(
        f'action stop; input s = topic /name.data entity e {{ r: s = "auto"; }} {STOP}',
        ("judged_e_r", "take_s"),
    ),
    "angle": Construct(
        "action stop; input q = topic /imu.orientation "
        f"entity e {{ r: q.roll() > 10 deg; }} {STOP}",
        ("judged_e_r", "roll", "take_q"),
    ),
    "scan": Construct(
        "action stop; input s = topic /scan "
        f"entity e {{ r: s.nearest(-30 deg, 30 deg) < 0.4; }} {STOP}",
        ("judged_e_r", "is_within", "is_least_of", "nearest", "scan_usable"),
    ),
    "rate": Construct(
        f"action stop; {SPEED} entity e {{ r: v.rate() > 2; }} {STOP}",
        ("judged_e_r", "rate"),
    ),
    "nested_behaviour": Construct(
        f"action stop; action horn; {SPEED} entity e {{ r: v > 1; s: v > 2; }} "
        "if e.r then { stop; if e.s then { horn; }; };",
        ("emitted_by_event", "acted"),
    ),
    "latched_action": Construct(
        f"action stop latched; {SPEED} entity e {{ r: v > 1.5; }} {STOP}",
        ("latched_kept", "settle_stop", "small_latch_stop", "small_reset"),
    ),
    "reset_by": Construct(
        f"action stop reset_by ok; action ok; {SPEED} entity e {{ r: v > 1; s: v < 0; }} "
        f"{STOP} if e.s then {{ ok; }};",
        ("emitted_by_settle_stop", "settle_stop"),
    ),
    "optional_behaviour": Construct(
        f"action stop; {SPEED} entity e {{ r: v > 1.5; }} "
        "optional behaviour near: if e.r then { stop; };",
        ("acted_behave_near", "small_enable_near"),
    ),
}
"""Constructs by name; the programs are all called ``small``."""


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


def test_contracts_match_golden(golden: Golden) -> None:
    """The contracts of the smallest program, and those that state the meaning of a construct."""
    smallest = contracts("action stop; input b = topic /flag.data entity e { r: b; } " + STOP)
    files = {"smallest.h": smallest}
    for name, construct in CONSTRUCTS.items():
        declared = excerpt(contracts(construct.rules), construct.declarations)
        files[f"{name}.h"] = f"/* {construct.rules} */\n\n{declared}"
    golden.check(
        "monitor_c_contracts", {name: File(text, Owner.USER) for name, text in files.items()}
    )


def test_excerpt_names_missing_declarations() -> None:
    """A declaration that is renamed must not vanish from the review."""
    with pytest.raises(AssertionError):
        excerpt(contracts(CONSTRUCTS["comparison"].rules), ("judged_nothing",))
