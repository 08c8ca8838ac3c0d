"""Contracts follow from the rules: the code fulfils them, and mutated code does not."""

from __future__ import annotations

import re
from pathlib import Path

import pytest

from tests.support import c_proof, rules
from tests.support.c_eva import TABLES_CHECK
from tests.support.c_everything import everything, examples
from tests.support.c_harness import Unit, unit
from tests.support.needs import needs
from tests.support.tables import rows
from tools import prove

PROVED = ("lasting", "judge_drive_system_max_speed_exceeded", "expire_speed", "settle_stop")
"""Functions of the smallest example that are proved within seconds; `make prove` proves all."""

SLIPS = {
    each["slip"]: (each["function"], each["right"], each["wrong"])
    for each in rows("slips", "Proof")
}
"""Mutations by name: the function, the right text, and the wrong text."""


@pytest.fixture(scope="module")
def example() -> Unit:
    """Return the monitor of the smallest example."""
    (found,) = (each for each in examples() if each.name == "intelligent_one")
    return unit(found)


def written(monitor: Unit, folder: Path, source: str | None = None) -> Path:
    """Write a monitor, possibly mutated, and return its source."""
    path = folder / f"{monitor.prefix}_monitor.c"
    for name, text in monitor.texts.items():
        (folder / name).write_text(text, encoding="utf-8")
    path.write_text(source or monitor.source, encoding="utf-8")
    return path


@needs("frama-c", "why3", "z3", "cvc4")
def test_contracts_are_proved(example: Unit, tmp_path: Path) -> None:
    """No goal is left, and nothing is assumed."""
    proof = c_proof.prove(written(example, tmp_path), PROVED)
    assert proof.left == ()
    assert proof.complaints == ()
    assert proof.is_complete


INPUTS = "input v = topic /speed.data timeout 1 sec input f = topic /flag.data timeout 1 sec"
ACTIONS = "action stop reset_by free; action free;"

CONSTRUCTS = {
    "rates": (
        """
input v = topic /speed.data timeout 1 sec
input q = topic /imu.orientation timeout 1 sec
entity e { r: v.rate() > 1; s: q.yaw().rate(0.1 sec) > 1; }
action stop;
if e.r or e.s then { stop; };
""",
        "rate|unwrapped|between|stamp_of|keep",
        5,
    ),
    "rules that name rules": (
        f"""{INPUTS} {ACTIONS}
entity e {{ failsafe danger: (fast for 0.5 sec) and not calm; fast: v > 1; calm: fast and f; }}
if e.danger then {{ stop; }};
if not e.calm then {{ free; }};
""",
        ".*judge.*|evaluate|after_v|after_f",
        10,
    ),
    "since": (
        f"""{INPUTS} {ACTIONS}
entity e {{ high: v >= 1 since v > 2; failsafe unanswered: (not f since high) for 1 sec; }}
if e.unanswered then {{ stop; }};
if not e.high since e.unanswered then {{ free; }};
""",
        "(judge|behave|after|take|restart).*|act|evaluate|step_back",
        17,
    ),
    "within": (
        f"""{INPUTS} {ACTIONS}
entity e {{ moved: v > 1 within 2 sec; failsafe both: (moved and f within 0.5 sec) for 1 sec; }}
if e.both then {{ stop; }};
if (not e.moved) within 3 sec then {{ free; }};
""",
        "(judge|behave|after|restart|recent|earliest).*|act|evaluate|step_back",
        17,
    ),
    "arithmetic": (
        """
input v = topic /speed.data timeout 1 sec
input m = topic /mode.data timeout 1 sec
entity e {
  r: v * v / (2 * m) > abs(v - v.previous());
  failsafe s: max(v, m, 0.5) > sqrt(v + 1) and sin(v) < 0.5;
}
action stop;
if e.r and e.s then { stop; };
""",
        "(compute|previous|forget|judge|observe_m).*",
        14,
    ),
}
"""Rules by the construct in them, a pattern of the functions that mean it, and their number."""


@pytest.mark.slow
@needs("frama-c", "why3", "z3", "cvc4")
@pytest.mark.parametrize("construct", CONSTRUCTS)
def test_contracts_of_construct_are_proved(construct: str, tmp_path: Path) -> None:
    """The functions of the construct do what the rules mean, also when nothing is new."""
    text, pattern, count = CONSTRUCTS[construct]
    source = c_proof.write(rules.program(text), tmp_path)
    functions = [each for each in c_proof.functions_of(source) if re.fullmatch(pattern, each)]
    assert len(functions) == count
    proof = c_proof.prove(source, functions)
    assert proof.left == ()
    assert proof.is_complete


@needs("frama-c", "why3", "z3", "cvc4")
@pytest.mark.slow(seconds=30)
@pytest.mark.parametrize("slip", SLIPS)
def test_mutation_fails_the_proof(
    slip: str, example: Unit, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    """The proof command fails and names the mutated function."""
    function, right, wrong = SLIPS[slip]
    definition = re.search(rf"^(?:static )?\w+ {function}\(.*?^}}", example.source, re.M | re.S)
    assert definition is not None
    assert right in definition.group()
    start, end = definition.span()
    slipped = definition.group().replace(right, wrong)
    source = example.source[:start] + slipped + example.source[end:]
    path = written(example, tmp_path, source)
    assert prove.main([str(path), "--functions", function, "--timeout", "3"]) == 1
    assert f"not proved: typed_{function}_" in re.sub(r"\s+", " ", capsys.readouterr().out)


@needs("frama-c", "why3", "z3", "cvc4")
@pytest.mark.parametrize(
    ("right", "wrong"), [("21U, arguments_1", "22U, arguments_1"), ("arguments_3, 1U", "NULL, 0U")]
)
def test_wrong_table_is_detected(right: str, wrong: str, tmp_path: Path) -> None:
    """The table of the emitted sites is compared with the rules."""
    (program,) = (each for each in examples() if each.name == "intelligent_one")
    source = c_proof.write(program, tmp_path)
    text = source.read_text(encoding="utf-8")
    assert c_proof.analyse(source, TABLES_CHECK).is_clean
    assert right in text
    source.write_text(text.replace(right, wrong), encoding="utf-8")
    assert not c_proof.analyse(source, TABLES_CHECK).is_clean


@needs("frama-c", "why3", "z3", "cvc4")
@pytest.mark.slow
def test_lemmas_must_be_proved(tmp_path: Path) -> None:
    """Lemmas of the contracts are goals as well, and fail the proof if they are wrong."""
    (tmp_path / "order_contracts.h").write_text(
        "/*@ lemma right: \\forall double a; !\\is_NaN(a) ==> \\le_double(a, a); */\n"
        "/*@ lemma wrong: \\forall double a; \\le_double(a, a); */\n",
        encoding="utf-8",
    )
    source = tmp_path / "order_monitor.c"
    source.write_text(
        '#include "order_contracts.h"\n'
        "/*@ assigns \\nothing; ensures \\result == 1; */\nint one(void)\n{\n  return 1;\n}\n",
        encoding="utf-8",
    )
    proof = c_proof.prove(source, timeout_s=3)
    assert proof.left == ("typed_lemma_wrong",)
    assert not proof.is_complete


def test_every_function_has_a_contract() -> None:
    """The contracts cover exactly the functions that the monitor defines."""
    for program in (everything(), *examples()):
        monitor = unit(program)
        contracts = monitor.texts[f"{monitor.prefix}_contracts.h"]
        declared = re.findall(r"^\w[^;{}=#\"]*?\b(\w+)\([^;{}]*\);", contracts, re.MULTILINE)
        assert declared == [f"{monitor.prefix}_emit", *c_proof.functions_in(monitor.source)]
        assert len(declared) == len(re.findall(r"^/\*@ (?:requires|assigns)", contracts, re.M))


def test_contracts_are_not_compiled(example: Unit) -> None:
    """Without Frama-C the compiler sees nothing of the contracts."""
    assert '#ifdef __FRAMAC__\n#include "intelligent_one_contracts.h"\n#endif' in example.source


LOGS = {
    "all": "[wp] Proved goals:   3 / 3\n",
    "one left": "[wp] [Failed] Goal typed_f_ensures\n[wp] Proved goals:   2 / 3\n",
    "another left": "[wp] [Timeout] Goal typed_ff_ensures\n[wp] Proved goals:   2 / 3\n",
    "a lemma left": "[wp] [Failed] Goal typed_lemma_le\n[wp] Proved goals:   2 / 3\n",
    "a stranger left": "[wp] [Failed] Goal typed_g_ensures\n[wp] Proved goals:   2 / 3\n",
    "no end": "[wp] [Failed] Goal typed_ff_ensures\n",
}


@pytest.mark.parametrize(
    ("tries", "left", "proved"),
    [
        (["all"], 0, ["f", "ff", c_proof.LEMMAS]),
        (["one left", "all"], 0, ["f", "ff", c_proof.LEMMAS]),
        (["one left", "another left"], 0, ["f", "ff", c_proof.LEMMAS]),
        (["one left", "one left"], 1, ["ff", c_proof.LEMMAS]),
        (["another left", "another left"], 1, ["f", c_proof.LEMMAS]),
        (["a lemma left", "a lemma left"], 1, ["f", "ff"]),
        (["a stranger left", "a stranger left"], 1, []),
        (["one left", "no end"], 0, []),
        (["no end", "all"], 0, []),
    ],
    ids=lambda each: " and ".join(each) if isinstance(each, list) else "",
)
def test_what_several_tries_prove(tries: list[str], left: int, proved: list[str]) -> None:
    """A goal is proved if one try proves it; a try that ends early proves nothing."""
    proof = c_proof.outcome([[LOGS[each] for each in tries]])
    assert len(proof.left) == left
    assert proof.proved_of(["f", "ff", c_proof.LEMMAS]) == proved
    assert proof.is_complete == (len(proved) == 3)
