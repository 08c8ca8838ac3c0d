"""The results of tests of rules: as text for people, as JSON, and as JUnit's XML."""

from __future__ import annotations

import json
import os
import xml.etree.ElementTree as ET
from collections.abc import Iterator, Sequence
from typing import TYPE_CHECKING, Any, TextIO

from deros.diagnostics import encodable
from deros.report.text import counted, printable

if TYPE_CHECKING:
    from deros.report.text import Piece
    from deros.simulation.timelines.coverage import Gap
    from deros.simulation.timelines.outcomes import Difference, Outcome, Player
    from deros.simulation.timelines.results import RuleTests

_MARGIN = "    "
_MOST = 20
"""So many differences of a timeline are shown to people."""


def print_text(results: RuleTests, out: TextIO) -> None:
    """Write the results for people, coloured if the stream is a terminal."""
    if not (out.isatty() and not os.environ.get("NO_COLOR")):
        out.write("".join(text for text, _ in _pieces(results)))
        return
    from rich.console import Console
    from rich.text import Text

    console = Console(file=out, soft_wrap=True, highlight=False, emoji=False, markup=False)
    console.print(Text.assemble(*_pieces(results)), end="")


def _pieces(results: RuleTests) -> Iterator[Piece]:
    for outcome in results.outcomes:
        if outcome.differences:
            yield from _failure(outcome)
    failed = sum(bool(each.differences) for each in results.outcomes)
    errors = sum(each.is_error for each in results.diagnostics)
    style = "bold red" if failed or errors else "bold green"
    more = f", {counted(errors, 'error')}" if errors else ""
    yield f"{counted(len(results.outcomes), 'timeline')} played, {_result(failed)}{more}\n", style
    for file, players in _by_file(results.players):
        yield from _covered(file, players)
    for file in results.unplayed:
        yield f"{printable(file)}: ", "bold"
        yield "no timeline plays it\n", "yellow"


def _result(failed: int) -> str:
    if not failed:
        return "no differences"
    return f"{failed} {'differs' if failed == 1 else 'differ'}"


def _failure(outcome: Outcome) -> Iterator[Piece]:
    span = outcome.timeline.span
    yield f"{printable(span.file)}:{span.line}: ", "bold"
    yield f"{printable(outcome.timeline.name)}\n", "bold red"
    for each in outcome.differences[:_MOST]:
        where = "" if each.span == span else f" (line {each.span.line})"
        yield f"{_MARGIN}{printable(each.text)}{where}\n", ""
        for reason in each.why:
            yield f"{_MARGIN * 2}{printable(reason)}\n", "cyan"
    if (rest := len(outcome.differences) - _MOST) > 0:
        yield f"{_MARGIN}and {counted(rest, 'more difference')}\n", ""


def _covered(file: str, players: Sequence[Player]) -> Iterator[Piece]:
    seen, total = _counts(players)
    gaps = [gap for each in players for gap in each.coverage.gaps()]
    yield f"{printable(file)}: ", "bold"
    if not gaps:
        yield "the timelines reach all of it\n", "green"
        return
    yield f"the timelines reach {seen} of {total} verdicts, and not\n", "yellow"
    for each in gaps:
        yield f"{_MARGIN}line {each.span.line}: {printable(gap_text(each))}\n", ""


def gap_text(gap: Gap) -> str:
    """Return what no timeline reaches, in words."""
    if gap.kind == "behaviour":
        return f"{gap.name} acts"
    what = gap.name if gap.kind == "rule" else f"{gap.name}: '{gap.text}'"
    return f"{what} is {str(gap.never).lower()}"


def _by_file(players: Sequence[Player]) -> Iterator[tuple[str, list[Player]]]:
    for file in dict.fromkeys(each.file for each in players):
        yield file, [each for each in players if each.file == file]


def _counts(players: Sequence[Player]) -> tuple[int, int]:
    return sum(each.coverage.seen for each in players), sum(each.coverage.total for each in players)


# JSON ---------------------------------------------------------------------------------------------


def render_json(results: RuleTests) -> str:
    """Return an object with the timelines, what they reach, and the rules that have none."""
    record = {
        "timelines": [_timeline(each) for each in results.outcomes],
        "coverage": [_coverage(*each) for each in _by_file(results.players)],
        "unplayed": [encodable(each) for each in results.unplayed],
    }
    return json.dumps(record, indent=2, ensure_ascii=False) + "\n"


def _timeline(outcome: Outcome) -> dict[str, Any]:
    span = outcome.timeline.span
    return {
        "file": encodable(span.file),
        "line": span.line,
        "name": outcome.timeline.name,
        "passed": not outcome.differences,
        "differences": [_difference(each) for each in outcome.differences],
    }


def _difference(difference: Difference) -> dict[str, Any]:
    from deros.simulation.timelines.timeline import decimal

    return {
        "t": decimal(difference.t_ns),
        "line": difference.span.line,
        "message": difference.text,
        "why": list(difference.why),
    }


def _coverage(file: str, players: Sequence[Player]) -> dict[str, Any]:
    seen, total = _counts(players)
    gaps = [
        {
            "line": gap.span.line,
            "kind": gap.kind,
            "name": gap.name,
            "text": gap.text,
            "never": gap.never,
        }
        for each in players
        for gap in each.coverage.gaps()
    ]
    return {"file": encodable(file), "seen": seen, "total": total, "gaps": gaps}


# JUnit --------------------------------------------------------------------------------------------


def render_junit(results: RuleTests) -> str:
    """Return the results as a suite for each file of timelines; errors are in one of their own."""
    root = ET.Element("testsuites", name="deros test")
    for file in dict.fromkeys(each.timeline.span.file for each in results.outcomes):
        outcomes = [each for each in results.outcomes if each.timeline.span.file == file]
        failures = sum(bool(each.differences) for each in outcomes)
        suite = _suite(root, file, len(outcomes), failures=failures)
        for each in outcomes:
            case = _case(suite, file, each.timeline.name, each.timeline.span.line)
            if each.differences:
                text = "\n".join(line for one in each.differences for line in (one.text, *one.why))
                _verdict(case, "failure", each.differences[0].text, text)
    errors = [each for each in results.diagnostics if each.is_error]
    if errors:
        suite = _suite(root, "errors", len(errors), errors=len(errors))
    for error in errors:
        case = _case(suite, error.span.file, str(error.code), error.span.line)
        _verdict(case, "error", error.message, error.hint)
    ET.indent(root)
    return ET.tostring(root, encoding="unicode", xml_declaration=True) + "\n"


def _suite(
    root: ET.Element, name: str, tests: int, *, failures: int = 0, errors: int = 0
) -> ET.Element:
    counts = {"tests": str(tests), "failures": str(failures), "errors": str(errors)}
    return ET.SubElement(root, "testsuite", {"name": printable(name), **counts})


def _case(suite: ET.Element, file: str, name: str, line: int) -> ET.Element:
    place = {"classname": printable(file), "file": printable(file), "line": str(line)}
    return ET.SubElement(suite, "testcase", {"name": printable(name), **place})


def _verdict(case: ET.Element, kind: str, message: str, text: str) -> None:
    verdict = ET.SubElement(case, kind, message=printable(message))
    verdict.text = "\n".join(map(printable, text.split("\n")))
