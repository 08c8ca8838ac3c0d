"""The timelines of tests: rules, a trace, and what must happen, worked out by hand.

``deros test`` plays them as well: their format is that of :mod:`deros.simulation.timelines`.
"""

from __future__ import annotations

from functools import cached_property
from pathlib import Path

from deros.diagnostics import SourceFile
from deros.interfaces.store import InterfaceStore
from deros.metamodels.load import Repository
from deros.models.rules import Rules
from deros.pipeline.rule_tests import rules_of_text
from deros.rules.compiler.build import build
from deros.rules.engine.engine import Event
from deros.rules.program.ir import Program
from deros.simulation.timelines import timeline as timelines
from deros.simulation.timelines.document import Case, RulesText, read_document
from deros.simulation.timelines.reading import read_timeline
from deros.simulation.timelines.timeline import Happening, decimal
from deros.simulation.trace import TraceMessage, read_trace

DIRECTORY = Path(__file__).resolve().parents[1] / "data" / "timelines"
FILES = sorted(DIRECTORY.glob("*.md"))


class Timeline:
    """A timeline whose rules stand beside it; rules and cells are read when they are asked for.

    Attributes:
        case: as it is written.
    """

    def __init__(self, case: Case) -> None:
        """Take a case with rules of its own."""
        self.case = case

    @property
    def name(self) -> str:
        """The heading, and the label of the table if it has one."""
        return self.case.name

    @property
    def label(self) -> str:
        """The label of the table, without the full stop."""
        return self.case.label

    @property
    def rules(self) -> str:
        """The statements."""
        return own_rules(self.case).text

    @cached_property
    def _program(self) -> Program:
        built, findings = rules_of_text(own_rules(self.case), InterfaceStore())
        assert built is not None, findings
        return built

    @cached_property
    def _timeline(self) -> timelines.Timeline:
        return read_timeline(self.case, self._program)

    @property
    def trace(self) -> tuple[str, ...]:
        """The lines of the trace."""
        return self._timeline.trace

    @property
    def expect(self) -> tuple[Happening, ...]:
        """All that has to happen."""
        return tuple(each.happening for each in self._timeline.effects)

    @property
    def until_ns(self) -> int:
        """The time up to which the clock runs on."""
        return self._timeline.until.t_ns

    @property
    def until(self) -> str:
        """The same in seconds."""
        return decimal(self.until_ns)

    def program(self) -> Program:
        """Return the rules, built."""
        return self._program

    def messages(self, program: Program) -> tuple[TraceMessage, ...]:
        """Read the trace, which must be faultless."""
        return messages(program, *self.trace)


def own_rules(case: Case) -> RulesText:
    """Return the rules that stand beside a timeline."""
    assert isinstance(case.rules, RulesText)
    return case.rules


def program(rules: str, name: str = "rules") -> Program:
    """Load and build rules on the system of the timelines; they must be faultless."""
    repository = Repository()
    model = repository.load_text(DIRECTORY / f"{name}.deros", rules).model
    assert isinstance(model, Rules), repository.diagnostics
    result = build(model, InterfaceStore())
    assert result.program is not None, result.diagnostics
    return result.program


def messages(program: Program, *lines: str) -> tuple[TraceMessage, ...]:
    """Read the lines of a trace, which must be faultless."""
    trace = read_trace(SourceFile("trace", "\n".join(lines)), program, InterfaceStore())
    assert not trace.diagnostics, trace.diagnostics
    return trace.messages


def happenings(events: list[Event]) -> tuple[Happening, ...]:
    """Return events as timelines list them, without steps of the clock."""
    return tuple((e.t_ns, e.action, e.kind) for e in events if e.kind != "clock_step")


def read(path: Path) -> list[Timeline]:
    """Return the timelines of a file, which must be faultless."""
    document = read_document(SourceFile(str(path), path.read_text("utf-8")))
    assert not document.diagnostics, document.diagnostics
    return [Timeline(each) for each in document.cases]


def system(path: Path) -> str:
    """Return the system description that a file prints for its timelines."""
    found = {own_rules(each.case).system for each in read(path)}
    (source,) = found
    assert source is not None
    return f"{source.text.strip()}\n"


GIVEN = read(DIRECTORY / "timelines.md")
MISREAD = read(DIRECTORY / "misread.md")
ALL = [*GIVEN, *(each for path in FILES if path.stem != "timelines" for each in read(path))]
