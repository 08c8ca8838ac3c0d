"""The C++ node gives the same causes as the reference, for any rules and any trace."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import pytest

from deros.rules.program import walk
from deros.rules.program.ir import Program, Scale
from tests.support import c_pairs, cpp_causes
from tests.support.c_harness import unit
from tests.support.c_monitors import CMonitor
from tests.support.monitors import START_NS
from tests.support.needs import needs
from tests.support.profiles import scaled
from tests.support.rules import program
from tests.support.strategies import ALL_KINDS

pytestmark = needs("gcc", "g++", "c++")

PROGRAMS = scaled(35)
"""Number of programs drawn per property; five traces are compared for each."""

# The C monitor stores no text that its rules do not contain, and so reports none.
KINDS = {
    "all kinds": tuple(kind for kind in ALL_KINDS if not kind.startswith("text")),
    "few values": ("number", "boolean"),
}


def _keeps_values(program: Program) -> bool:
    """Return whether C stores values in their own units; a conversion may lose a digit."""
    return not any(isinstance(each, Scale) for each in walk.values(walk.conditions(program)))


WORDS = """
    action stop;
    const limit = 2.5
    input u = topic /odom.twist.twist.linear.x
    input n = topic /name.data
    input s = topic /status.level
    entity e {
      fast: u > 5 km/h for 0 sec;
      named: n = "a{b}'c\\"" or n != "auto";
      ill: s = ERROR and not (u <= limit);
      now: u > 1 within 0 sec;
    }
    behaviour b: if e.fast then { stop; };
    """


@dataclass(frozen=True)
class Compiled:
    """The monitors of all tests in one library, which reads the headers once.

    The first one is that of :data:`WORDS`; those of the cases of each kind follow in order.
    """

    library: cpp_causes.Told
    cases: Mapping[str, Sequence[c_pairs.Case]]


@pytest.fixture(scope="module")
def compiled(tmp_path_factory: pytest.TempPathFactory) -> Compiled:
    """Compile the monitors and the reports of their causes."""
    cases = {
        name: c_pairs.cases(kinds, PROGRAMS, 1, first=number * PROGRAMS, accept=_keeps_values)
        for number, (name, kinds) in enumerate(KINDS.items())
    }
    units = [unit(program(WORDS)), *(case.unit for name in cases for case in cases[name])]
    return Compiled(cpp_causes.Told(units, tmp_path_factory.mktemp("causes")), cases)


@pytest.mark.parametrize("kinds", KINDS)
def test_causes_match_the_reference(kinds: str, compiled: Compiled) -> None:
    """Every true rule and every active behaviour is compared after every call."""
    first = 1 + list(KINDS).index(kinds) * PROGRAMS
    told = sum(
        cpp_causes.compare(compiled.library, number, pair)
        for number, case in enumerate(compiled.cases[kinds], first)
        for pair in case.pairs
    )
    assert told > 20 * PROGRAMS, "too few rules were true"


def test_causes_use_the_words_of_the_rules(compiled: Compiled) -> None:
    """Units, names of constants and strings are as written; braces and quotes are preserved."""
    built, library = compiled.library.units[0].program, compiled.library
    monitor = CMonitor(library, 0, START_NS)
    leaves = {built.inputs[leaf.input].name: leaf.index for leaf in built.leaves}
    monitor.message(START_NS, "/odom", {leaves["u"]: 3.0})
    monitor.message(START_NS, "/name", {leaves["n"]: "a{b}'c\""})
    monitor.message(START_NS, "/status", {leaves["s"]: 2})
    assert library.tell(0).splitlines() == [
        "e.fasttrue\tu 3.0 m/s > 5 km/h for 0 sec",
        'e.namedtrue\tn = "a{b}\'c""\tn "a{b}\'c"" != "auto"',
        "e.illtrue\ts = ERROR\tu 3.0 > 2.5",
        "e.nowtrue\tu 3.0 > 1",
        "0\te.fast: u 3.0 m/s > 5 km/h for 0 sec",
    ]
