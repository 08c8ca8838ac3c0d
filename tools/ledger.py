"""The ledger of proofs: which functions of the examples are proved, by a digest of what that reads.

``tools/proof/proved.json`` holds a digest for each function of a program, and for two things more:
the lemmas, and the analysis of run-time errors. A function whose digest is there need not be proved
again. ``make prove`` reads the ledger and proves the rest; with ``RECORD=1`` it also adds what it
has proved. The nightly run proves everything, whatever the ledger says.

A digest is made of all that the proof of a function reads: its body, its contract, those of the
functions that it calls, the definitions that these name, transitively, all axioms and lemmas, the
header, the rest of the source without other bodies, and how the provers are asked. No prover reads
comments, which quote the rules and their lines, nothing reads the values of the lines that actions
are reported with, and ``inline`` is a hint for compilers: another layout of the rules, a line more
above, or another hint needs no proof.
"""

from __future__ import annotations

import hashlib
import json
import re
from pathlib import Path

from tests.support import c_proof
from tests.support.c_proof_texts import ProofTexts

PATH = Path(__file__).parent / "proof" / "proved.json"

ERRORS = "@run-time errors"
"""What stands beside the functions and lemmas of a program: the analysis by Eva."""

_PLACE = re.compile(r"(\w+_BEHAVIOUR_\w+, |\.line != )\d+U\b")
"""The line of the rules in an entry of the table of actions, and where a driver reads it."""

_READS_PLACE = re.compile(r"(?:\.|->)\s*line\b")

_COMMENT = re.compile(
    r'"(?:[^"\\\n]|\\.)*"|/\*@.*?\*/|//@[^\n]*'
    r"|(?P<comment>[ \t]*(?:/\*.*?\*/|//[^\n]*)[ \t]*\n?)",
    re.DOTALL,
)
"""A comment, or what is none though it may look like one: a text, a contract."""

_BODY = re.compile(r"^\{\n.*?^\}", re.MULTILINE | re.DOTALL)


class Ledger:
    """The digests of what is proved, by program and function."""

    def __init__(self, path: Path = PATH) -> None:
        """Read the ledger, if there is one."""
        self._path = path
        self._digests: dict[str, dict[str, str]] = {}
        if path.exists():
            self._digests = json.loads(path.read_text(encoding="utf-8"))

    def open(self, program: str, source: Path) -> list[str]:
        """Return what is to be proved of a program, because its digest is not in the ledger."""
        known = self._digests.get(program, {})
        return [name for name, digest in digests(source).items() if known.get(name) != digest]

    def stale(self, program: str, source: Path) -> list[str]:
        """Return what the ledger has of a program and the source has not, or has otherwise."""
        present = digests(source)
        known = self._digests.get(program, {})
        return [name for name, digest in known.items() if present.get(name) != digest]

    def record(self, program: str, source: Path, proved: list[str]) -> None:
        """Add what has been proved, drop what is no longer there, and write the ledger."""
        present = digests(source)
        known = self._digests.get(program, {})
        kept = {name: digest for name, digest in known.items() if present.get(name) == digest}
        kept |= {name: present[name] for name in proved}
        self._digests[program] = dict(sorted(kept.items()))
        text = json.dumps(dict(sorted(self._digests.items())), indent=1)
        self._path.write_text(text + "\n", encoding="utf-8")


def digests(source: Path) -> dict[str, str]:
    """Return the digests of a program: of its functions, of its lemmas and of its analysis."""
    texts = ProofTexts(source, _read_by_provers)
    text = _without_places(texts, texts.text)
    skeleton = _BODY.sub("{}", text)
    shared = "\0".join([c_proof.settings(), skeleton])
    found = {
        name: _digest(shared, texts.digest(name, text, "")) for name in c_proof.functions_of(source)
    }
    if c_proof.has_lemmas(source):
        found[c_proof.LEMMAS] = _digest(shared, texts.header, *texts.facts)
    driver = without_comments((source.parent / "eva.c").read_text(encoding="utf-8"))
    driver = _without_places(texts, driver)
    found[ERRORS] = _digest(text, texts.header, driver, c_proof.settings())
    return found


def without_comments(text: str) -> str:
    """Return a text in C without its comments, contracts and texts as they are."""
    return _COMMENT.sub(lambda found: "" if found["comment"] else found[0], text)


def _read_by_provers(text: str) -> str:
    return without_comments(text).replace("static inline ", "static ")


def _without_places(texts: ProofTexts, text: str) -> str:
    """Return a text without the lines of the rules that actions come from.

    They are handed to the host, and no contract reads them; in one that does, they stay.
    """
    read = _READS_PLACE.search(texts.contracts)
    return text if read else _PLACE.sub(r"\1LINE", text)


def _digest(*parts: str) -> str:
    return hashlib.sha256("\0".join(parts).encode()).hexdigest()[:20]
