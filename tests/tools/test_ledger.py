"""The ledger of proofs: what has to be proved again after a change."""

from __future__ import annotations

import re
from pathlib import Path

import pytest

from tests.support import c_proof
from tests.support.needs import needs
from tools.ledger import ERRORS, Ledger, digests, without_comments
from tools.prove import main, program_of

EXAMPLE = Path(__file__).parents[2] / "examples/intelligent_one/intelligent_one.deros"


@pytest.fixture
def source(tmp_path: Path) -> Path:
    """Return the source of the smaller example, with its contracts beside it."""
    return c_proof.write(program_of(EXAMPLE), tmp_path / "source")


@pytest.fixture
def ledger(source: Path, tmp_path: Path) -> Ledger:
    """Return a ledger in which all of the example is proved."""
    found = Ledger(tmp_path / "proved.json")
    found.record("example", source, list(digests(source)))
    return Ledger(tmp_path / "proved.json")


def replace(path: Path, before: str, after: str) -> None:
    """Change a text at the first place where it has something."""
    text = path.read_text(encoding="utf-8")
    assert before in text
    path.write_text(text.replace(before, after, 1), encoding="utf-8")


def beside(source: Path, suffix: str) -> Path:
    """Return another file of the monitor."""
    return source.with_name(source.name.replace("_monitor.c", suffix))


def test_what_is_recorded_is_not_open(ledger: Ledger, source: Path) -> None:
    """All functions and the analysis are known; of another program nothing is."""
    assert ledger.open("example", source) == []
    assert ledger.stale("example", source) == []
    assert set(ledger.open("other", source)) == {*c_proof.functions_of(source), ERRORS}


@needs("frama-c", "why3", "z3", "cvc4", "gcc")
def test_proved_program_needs_no_proof(
    source: Path,
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
    capsys: pytest.CaptureFixture[str],
) -> None:
    """The command says so, and passes."""
    ledger = Ledger(tmp_path / "proved.json")
    ledger.record(EXAMPLE.stem, source, list(digests(source)))
    monkeypatch.setattr("tools.prove.Ledger", lambda: ledger)
    assert main(["--new", str(EXAMPLE)]) == 0
    assert "55 of 55 functions known to be proved; to prove: 0" in capsys.readouterr().out


def test_changed_body_opens_its_function_alone(ledger: Ledger, source: Path) -> None:
    """The proofs of others read its contract, not its body."""
    replace(source, "  m->stop_active = false;", "  m->stop_active = true;")
    assert set(ledger.open("example", source)) == {"settle_stop", ERRORS}
    assert set(ledger.stale("example", source)) == {"settle_stop", ERRORS}


def test_hint_for_compilers_opens_nothing(ledger: Ledger, source: Path) -> None:
    """Whether a function is inline is nothing that provers know."""
    replace(source, "static inline void arrive(", "static void arrive(")
    assert ledger.open("example", source) == []


def test_changed_contract_opens_the_functions_that_read_it(ledger: Ledger, source: Path) -> None:
    """They are the function itself and its callers, not all."""
    contracts = beside(source, "_contracts.h")
    replace(contracts, "predicate judged_", "predicate  judged_")
    opened = ledger.open("example", source)
    assert opened
    assert len(opened) < len(c_proof.functions_of(source))


def test_changed_predicate_opens_those_who_name_it(ledger: Ledger, source: Path) -> None:
    """It stands beside axioms and lemmas, and opens no proof that does not read it."""
    replace(beside(source, "_contracts.h"), "/*@ predicate judged_", "/*@ predicate judged__")
    opened = ledger.open("example", source)
    assert 0 < len(opened) < len(c_proof.functions_of(source)) / 2
    assert c_proof.LEMMAS not in opened


@pytest.mark.parametrize(
    "text", ["axiom ", "/*@ axiomatic ", "/*@ ghost ", "/*@ logic integer emitted_by_"]
)
def test_changed_fact_opens_everything(ledger: Ledger, source: Path, text: str) -> None:
    """A prover may use it, and what it names, for any function, whatever its contract names."""
    replace(beside(source, "_contracts.h"), text, f"{text} ")
    assert {*c_proof.functions_of(source)} <= set(ledger.open("example", source))


def test_line_of_the_rules_opens_nothing_unless_a_contract_reads_it(
    ledger: Ledger, source: Path
) -> None:
    """The lines are in the table of actions, for the host."""
    text = source.read_text(encoding="utf-8")
    moved, count = re.subn(r"(_BEHAVIOUR_\w+, )\d+U", r"\g<1>4711U", text)
    assert count
    source.write_text(moved, encoding="utf-8")
    assert ledger.open("example", source) == []
    contracts = beside(source, "_contracts.h")
    replace(contracts, "requires ", "requires sites[0].line == 4711 && ")
    assert len(ledger.open("example", source)) == len(digests(source))


@pytest.mark.parametrize("suffix", ["_monitor.h", "_monitor.c", "_contracts.h"])
def test_changed_comment_opens_nothing(ledger: Ledger, source: Path, suffix: str) -> None:
    """Comments quote the rules, and change with the layout of these."""
    path = beside(source, suffix)
    text = path.read_text(encoding="utf-8")
    said, count = re.subn(r"/\*(?!@)(.*?)\*/", r"/* more:\n *\1*/", text, flags=re.DOTALL)
    assert count
    path.write_text(f"{said}// the end\n", encoding="utf-8")
    assert ledger.open("example", source) == []


def test_what_looks_like_a_comment_is_kept() -> None:
    """Texts and contracts, whatever is in them; a comment goes whatever is in it."""
    kept = 'char * a = "/* \\" // */";\n/*@ requires b; // why\n */\n//@ assert c;\nd / e;\n'
    assert without_comments(kept) == kept
    assert without_comments('a; // "b\n/* //@ c\n"d */e;\n') == "a;e;\n"


@pytest.mark.parametrize("suffix", ["_monitor.h", "_monitor.c"])
def test_changed_declaration_opens_everything(ledger: Ledger, source: Path, suffix: str) -> None:
    """Types and constants may matter to every function."""
    path = beside(source, suffix)
    path.write_text(f"{path.read_text(encoding='utf-8')}\n#define MORE 1\n", encoding="utf-8")
    assert set(ledger.open("example", source)) == {*c_proof.functions_of(source), ERRORS}


def test_changed_prover_opens_everything(
    ledger: Ledger, source: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """A proof by other provers, or with other assumptions, is another proof."""
    monkeypatch.setattr(c_proof, "PROVERS", "alt-ergo")
    assert set(ledger.open("example", source)) == {*c_proof.functions_of(source), ERRORS}


def test_vanished_functions_leave_the_ledger(ledger: Ledger, source: Path, tmp_path: Path) -> None:
    """Recording drops digests that no longer match."""
    replace(source, "  m->stop_active = false;", "  m->stop_active = true;")
    stale = ledger.stale("example", source)
    ledger.record("example", source, [])
    again = Ledger(tmp_path / "proved.json")
    assert again.stale("example", source) == []
    assert set(again.open("example", source)) == set(stale)
