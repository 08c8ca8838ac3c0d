"""QoS of whole systems: pairs of many ends, hints that work, and ends of generated nodes."""

from __future__ import annotations

import itertools
import re
from pathlib import Path

import pytest

from deros.diagnostics import Diagnostic
from deros.generators.gate.nodes import gate_nodes
from deros.generators.safety_node.node import safety_node
from deros.interfaces.store import InterfaceStore
from deros.metamodels.load import Repository
from deros.models.node import PortKind
from deros.models.rules import Rules
from deros.names.graph_names import resolve_name
from deros.rules.compiler.build import build
from deros.validators.wiring.rules_ends import ends_of
from tests.support.checks import checked

ROOT = Path(__file__).resolve().parents[3]


def _check(folder: Path, publisher: str, subscriber: str, wiring: str = "") -> list[Diagnostic]:
    """Check two nodes on one topic, with the given text after their types."""
    (folder / "a.rnd").write_text(f"node a : demo publishes topic x : std_msgs.Bool {publisher}\n")
    (folder / "b.rnd").write_text(
        f"node b : demo subscribes topic x : std_msgs.Bool {subscriber}\n"
    )
    system = f"""\
system Demo
imports import "*.rnd"
topics topic /x
node a : a wirings connect x to /x
node b : b wirings connect x to /x
{wiring}
"""
    (folder / "demo.system").write_text(system)
    return checked(folder / "demo.system")


OFFERS = ["", "qos best_effort", "qos deadline 500 ms", "qos liveliness automatic lease 2 sec"]
REQUESTS = [
    "",
    "qos transient_local",
    "qos deadline 100 ms",
    "qos liveliness automatic lease 1 sec",
    "qos reliable transient_local deadline 100 ms liveliness manual_by_topic lease 1 sec",
]


@pytest.mark.parametrize(("offer", "request_"), list(itertools.product(OFFERS, REQUESTS)))
def test_qos_hint_fixes_the_mismatch(tmp_path: Path, offer: str, request_: str) -> None:
    """Following the hint at either end connects the two."""
    findings = _check(tmp_path, offer, request_)
    for finding in findings:
        assert finding.code.name == "DRS228"
        more = re.search(r"publisher offer '([^']*)'", finding.hint)
        less = re.search(r"subscription ask for (?:'([^']*)')?(?: and )?(.*)", finding.hint)
        assert more, finding.hint
        assert less, finding.hint
        assert _check(tmp_path, _changed(offer, more[1]), request_) == []
        taken = re.findall(r"no (\w+)", less[2])
        assert _check(tmp_path, offer, _changed(request_, less[1] or "", taken)) == []


def _changed(text: str, words: str, taken: list[str] | None = None) -> str:
    """Return a profile with some policies replaced."""
    policies = ["deadline", "lease"]
    for word in policies:
        if word in words or word in (taken or []):
            text = re.sub(rf" {word} \d+ \w+", "", text)
    for kinds in ("reliable|best_effort", "volatile|transient_local"):
        if re.search(kinds, words):
            text = re.sub(rf" ({kinds})", "", text)
    if "liveliness" in words:
        text = re.sub(r" liveliness (automatic|manual_by_topic)", "", text)
    text = f"{text or 'qos'} {words}".strip()
    lease = re.search(r"lease \d+ \w+", text)
    if lease and "liveliness" in text and not re.search(r"liveliness \w+ lease", text):
        text = text.replace(f" {lease[0]}", "").replace(
            "liveliness automatic", f"liveliness automatic {lease[0]}"
        )
    return "" if text == "qos" else text


def test_both_ends_are_shown(tmp_path: Path) -> None:
    """The finding shows both connections and both QoS statements."""
    (finding,) = _check(tmp_path, "qos best_effort", "qos reliable")
    places = [finding.span, *(related.span for related in finding.related)]
    assert {(Path(span.file).name, span.text) for span in places} == {
        ("demo.system", "connect x to /x"),
        ("a.rnd", "qos best_effort"),
        ("b.rnd", "qos reliable"),
    }
    assert [span.line for span in places if span.file.endswith("demo.system")] == [4, 5]
    assert "/a (x)" in finding.message
    assert "/b (x)" in finding.message


def test_ends_of_one_profile_are_grouped(tmp_path: Path) -> None:
    """The finding is at the side with fewer ends, which is asked to change."""
    more = "\n".join(f"node b{n} : b wirings connect x to /x" for n in range(300))
    (finding,) = _check(tmp_path, "", "qos transient_local", more)
    assert "/b (x), /b0 (x), /b1 (x) and 298 more" in finding.message
    more = "\n".join(f"node a{n} : a wirings connect x to /x" for n in range(300))
    (finding,) = _check(tmp_path, "", "qos transient_local", more)
    assert finding.span.line == 5


def test_unstated_qos_of_a_program_is_only_a_warning(tmp_path: Path) -> None:
    """An existing program may be best effort without saying so."""
    (tmp_path / "c.rnd").write_text(
        'node c : demo executable "c" subscribes topic x : std_msgs.Bool\n'
    )
    wiring = "node c : c wirings connect x to /x"
    findings = _check(tmp_path, "qos best_effort", "qos best_effort", wiring)
    assert [finding.code.name for finding in findings] == ["DRS229"]


RULES = sorted(
    path
    for folder in ("examples", "tests/generators", "tests/faults/models")
    for path in (ROOT / folder).rglob("*.deros")
)


@pytest.mark.parametrize("path", RULES, ids=lambda path: path.stem)
def test_ends_of_rules_match_the_generated_nodes(path: Path) -> None:
    """Topics, directions and QoS are the same in checks and generated nodes."""
    rules = Repository().load(path).model
    assert isinstance(rules, Rules)
    result = build(rules, InterfaceStore())
    if result.program is None:
        pytest.skip("rules with a fault")
    node = safety_node(result.program, result.topics, {}, rules.source)
    nodes = [node, *gate_nodes(result.program, result.topics, node)]
    kinds = (PortKind.PUBLISHER, PortKind.SUBSCRIPTION)
    ports = {
        (port.kind, resolve_name(port.name, "/", each.name)): port.qos
        for each in nodes
        for port in each.ports
        if port.kind in kinds
    }
    for end in ends_of([rules]).ends:
        assert ports[end.kind, end.topic] == end.qos


def test_type_and_qos_come_from_the_outermost_declaration(tmp_path: Path) -> None:
    """A declaration of an imported system applies where the outer one states nothing."""
    (tmp_path / "a.rnd").write_text("node a : demo publishes topic x : std_msgs.Bool\n")
    (tmp_path / "part.system").write_text(
        "system Part topics external topic /x : std_msgs.Empty qos transient_local\n"
    )
    (tmp_path / "demo.system").write_text(
        'system Demo imports import "a.rnd" import "part.system"\n'
        "topics topic /x\nnode a : a wirings connect x to /x\nsubsystem part : Part\n"
    )
    findings = checked(tmp_path / "demo.system")
    assert {finding.code.name for finding in findings} >= {"DRS209", "DRS230"}
