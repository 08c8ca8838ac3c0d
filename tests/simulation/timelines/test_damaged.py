"""Whatever is written in a file of timelines, reading it ends with timelines or findings."""

from __future__ import annotations

from hypothesis import given, settings
from hypothesis import strategies as st

from deros.diagnostics import SourceFile
from deros.simulation.timelines.document import read_document
from deros.simulation.timelines.lines import Fault
from deros.simulation.timelines.outcomes import Player
from deros.simulation.timelines.reading import read_entries, read_timeline
from tests.support import timelines
from tests.support.profiles import scaled
from tests.support.rules import embedded_store

PROGRAM = timelines.program(
    """use "robot.system" import Robot
action stop publishes true on /stop : std_msgs.Bool latched;
input v = topic /speed.data timeout 1 sec
entity e { r: v > 0.5; }
optional behaviour b: if e.r then { stop; };
"""
)
TEXT = """# Title

Rules: [robot.deros](robot.deros)

## First

**As meant.** Words.

| time until 2 s | message | effect | command |
|---|---|---|---|
| every 0.1 s until 1 s | v = 0.1 | | |
| 1.1 s, 1.2 s | /speed.data = 0.6 | | |
| 1.1 s | | stop | |
| 1.5 s | disable b | | |
| back to 0.5 s | reset | stop reset | |

| topic | fields |
|---|---|
| /scan | angle_min = -0.5, header.stamp = time |
"""
PIECES = [*"|#*`=.,:/[]{}\"'\\\n\x00é", *TEXT.split(), "1e999999999", "[" * 50, "9" * 5000]


@st.composite
def damaged(draw: st.DrawFn) -> str:
    """Draw the text with some pieces cut out, put in or repeated."""
    text = TEXT
    for _ in range(draw(st.integers(1, 6))):
        start = draw(st.integers(0, len(text)))
        end = min(len(text), start + draw(st.integers(0, 12)))
        text = text[:start] + draw(st.sampled_from(["", *PIECES])) + text[end:]
    return text


@settings(max_examples=scaled(500))
@given(damaged())
def test_damaged_text_ends_with_findings(text: str) -> None:
    """Each case is played, or there is a finding with its place and a message."""
    source = SourceFile("t.md", text)
    document = read_document(source)
    assert document.cases or document.diagnostics
    findings = list(document.diagnostics)
    player = Player("robot.deros", PROGRAM, embedded_store())
    for case in document.cases:
        try:
            timeline = read_timeline(case, PROGRAM)
        except Fault as fault:
            findings.append(fault.diagnostic)
            continue
        lines, found = read_entries(timeline, PROGRAM, embedded_store())
        findings += found
        if not found:
            player.play(timeline, lines)
    for finding in findings:
        assert finding.message
        assert 0 <= finding.span.start <= finding.span.end <= len(text)
