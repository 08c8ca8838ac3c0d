"""The timelines: rules, a trace, and what must happen, worked out by hand.

They are read from Markdown, as in ``docs/patterns.md``::

    ## name_of_the_timeline
    One sentence says why.
    `entity e { fast: v > 0.5 for 1 sec; }`
    `if e.fast then { stop; };`
    | time until 9 s | message | effect |
    |---|---|---|
    | 1 s | v = 0.6 | |
    | 2 s | | stop |
    | back to 1.5 s | v = 0.1, v.header.stamp.sec = 7 | stop reset, calm refused |

Rows are in order of time; a message at which the clock steps back says so. A message that comes
several times may have all of its times in one row, or ``1 s to 2 s every 0.1 s``, both ends
included, which stands where it begins. Fields are those of an input, or of a topic
(``/imu.orientation.x``); values are JSON, with NaN and infinities. An effect is a trigger, or says
``reset`` or ``refused``. Without ``until``, the clock stops with the last row. Rules of more than
two lines are in a block ``deros``. Without rules, a timeline has those of the timeline before it.

A timeline may have several tables, each below its label, text in bold at the start of a line. They
are timelines of their own, of the same rules: ``**Sensor lost: it never comes.** Then why.``
Timelines may also have headings of level 3, in groups with headings of level 2.

Below a heading of level 1 may stand what is common to the timelines that follow: statements, of
which a timeline has only those inputs and constants that its rules name and do not declare; and a
table ``| topic | fields |`` of fields that every message of a topic has. The value ``time`` of such
a field is the time of the message, as a stamp. Statements of a timeline replace common ones of the
same name. A block ``rossystem`` there is the system of all, which :func:`system` returns.
"""

from __future__ import annotations

import json
import re
from collections.abc import Iterator
from dataclasses import dataclass, field
from itertools import takewhile
from pathlib import Path

from deros.diagnostics import SourceFile
from deros.interfaces.durations import NS_PER_S
from deros.interfaces.store import InterfaceStore
from deros.metamodels.load import Repository
from deros.models.rules import Rules
from deros.rules.compiler.build import build
from deros.rules.engine.engine import Event
from deros.rules.program.ir import Program
from deros.simulation.trace import TraceMessage, nanoseconds, read_trace

DIRECTORY = Path(__file__).resolve().parents[1] / "data" / "timelines"
FILES = sorted(DIRECTORY.glob("*.md"))
Happening = tuple[int, str, str]
"""When, of which action, what: ``trigger``, ``reset`` or ``refused``."""


@dataclass(frozen=True)
class Timeline:
    """One case.

    Attributes:
        name: the heading, and the label of the table if it has one.
        trace: JSON texts, one a message.
        label: that of the table, without the full stop.
    """

    name: str
    why: str
    rules: str
    trace: tuple[str, ...]
    until: str
    expect: tuple[Happening, ...]
    label: str = ""

    @property
    def until_ns(self) -> int:
        """The time up to which the clock runs on."""
        until_ns = nanoseconds(self.until)
        assert until_ns is not None
        return until_ns

    def program(self) -> Program:
        """Load and build the rules."""
        return program(self.rules, self.name)

    def messages(self, program: Program) -> tuple[TraceMessage, ...]:
        """Read the trace, which must be faultless."""
        return messages(program, *self.trace)


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
    """Return the timelines of a file.

    Raises:
        TableError: the file is malformed.
    """
    found: list[Timeline] = []
    common, rules, fields = [], "", {}
    for section in _sections(path):
        if section.level == 1:
            common, rules = section.rules, ""
            tables = [section.rows(each, "topic", "fields") for each in section.tables]
            fields = {line.cells[0]: line for rows in tables for line in rows}
            continue
        if section.is_group:
            continue
        if section.rules:
            rules = _with_common(common, "\n".join(section.rules))
        if not rules:
            raise section.heading.fault("neither rules nor a timeline before it")
        if not section.tables:
            raise section.heading.fault("a timeline without a table")
        found += [_Table(section, each, rules, fields).timeline() for each in section.tables]
    return found


def system(path: Path) -> str:
    """Return the system description that a file prints for its timelines."""
    (text,) = ["\n".join(each.system) for each in _sections(path) if each.system]
    return f"{text}\n"


class TableError(Exception):
    """A file of timelines is malformed; the text begins with file and line."""


@dataclass(frozen=True)
class _Line:
    path: Path
    number: int
    text: str

    @property
    def cells(self) -> list[str]:
        return [each.strip() for each in self.text.strip("|").split("|")]

    def fault(self, text: str) -> TableError:
        return TableError(f"{self.path}:{self.number}: {text}: {self.text}")


@dataclass
class _Labelled:
    """A table and its label, empty for the only one of a timeline."""

    place: _Line
    label: str
    prose: list[str] = field(default_factory=list)
    lines: list[_Line] = field(default_factory=list)


@dataclass
class _Section:
    heading: _Line
    prose: list[str] = field(default_factory=list)
    rules: list[str] = field(default_factory=list)
    system: list[str] = field(default_factory=list)
    tables: list[_Labelled] = field(default_factory=list)
    is_group: bool = False

    @property
    def level(self) -> int:
        """The level of the heading."""
        return len(self.heading.text.partition(" ")[0])

    @property
    def last_row(self) -> _Line | None:
        """The last line of the last table."""
        return self.tables[-1].lines[-1] if self.tables and self.tables[-1].lines else None

    def add_row(self, line: _Line) -> None:
        """Add a line to the table that it belongs to."""
        if not self.tables:
            self.tables.append(_Labelled(self.heading, ""))
        self.tables[-1].lines.append(line)

    def rows(self, labelled: _Labelled, *columns: str) -> list[_Line]:
        """Return the rows below the names of the columns, the first of which may go on."""
        table = labelled.lines
        if not table:
            raise labelled.place.fault("a label without a table")
        for place, line in enumerate(table):
            if line.number != table[0].number + place:
                raise line.fault("a row apart from its table")
            if not re.fullmatch(r"\|.*\|", line.text) or len(line.cells) != len(columns):
                raise line.fault(f"not the cells | {' | '.join(columns)} |")
            if (place == 1) != (line.text == "|" + "---|" * len(columns)):
                raise line.fault("|---| belongs below the names of the columns, and only there")
        first, *others = table[0].cells
        if (first.split(" until ")[0], *others) != columns:
            raise table[0].fault(f"the columns are not | {' | '.join(columns)} |")
        return table[2:]


def _sections(path: Path) -> list[_Section]:
    """Split a file at its headings."""
    found = [_Section(_Line(path, 1, ""))]
    lines = (_Line(path, *each) for each in enumerate(path.read_text("utf-8").splitlines(), 1))
    for line in lines:
        last = found[-1]
        if line.text.startswith("#"):
            found.append(_Section(line))
            _nest(found)
        elif line.text.startswith("```"):
            block = {"```deros": last.rules, "```rossystem": last.system}.get(line.text)
            if block is None or block or (block is last.system and last.level > 1):
                raise line.fault("a second block, or not one of ```deros")
            block += [each.text for each in takewhile(lambda each: each.text != "```", lines)]
        elif last.level > 1 and (rule := re.fullmatch(r"`([^`]+)`", line.text)):
            if last.tables:
                raise line.fault("rules below the table")
            last.rules.append(rule[1])
        elif last.level > 1 and (label := re.match(r"\*\*(.+?)\.?\*\*", line.text)):
            if last.tables and not all(each.label for each in last.tables):
                raise line.fault("a label below a table without one")
            if any(each.label == label[1] for each in last.tables):
                raise line.fault("a second table of this label")
            last.tables.append(_Labelled(line, label[1], [line.text[label.end() :].strip()]))
        elif "|" in line.text:
            last.add_row(line)
        elif line.text and last.last_row and last.last_row.number == line.number - 1:
            raise line.fault("neither a row of the table above nor apart from it")
        else:
            (last.tables[-1].prose if last.tables else last.prose).append(line.text)
    return found[1:]


def _nest(sections: list[_Section]) -> None:
    """Make the section around the last one a group, if the last one is in one."""
    last = sections[-1]
    if last.level > 3:
        raise last.heading.fault("a heading is of level 1 to 3")
    if last.level < 3:
        return
    above = next((each for each in reversed(sections[:-1]) if each.level < 3), sections[0])
    if above.level != 2 or above.rules or above.tables:
        raise last.heading.fault("a heading of level 3 is in a group, below one of level 2")
    above.is_group = True


def _with_common(common: list[str], rules: str) -> str:
    """Return rules below the common statements that they need."""

    def is_needed(statement: str) -> bool:
        others = [each for each in common if each is not statement]
        declared = re.match(r"(input|const|action) (\w+)", statement)
        if not declared:
            return True
        if re.search(rf"\b{declared[0]}\b", rules):
            return False
        if declared[1] == "action":
            return any(re.search(rf"\b{declared[2]}\b", each) for each in (rules, *others))
        named = rf"(?<![\w./])(?<!\d ){declared[2]}\b(?!:)"  # neither a unit nor a rule
        return re.search(named, rules) is not None

    return "\n".join([*filter(is_needed, common), rules, ""])


class _Table:
    """Reads the table of a timeline."""

    def __init__(
        self, section: _Section, labelled: _Labelled, rules: str, common: dict[str, _Line]
    ) -> None:
        self._section = section
        self._labelled = labelled
        self._rules = rules
        self._common = common  # the rows that list the fields of every message of a topic
        found = re.findall(r"^input (\w+) = topic (/[\w/]+)(\S*)", rules, re.MULTILINE)
        self._inputs = {name: (topic, path) for name, topic, path in found}

    def timeline(self) -> Timeline:
        trace: list[tuple[tuple[int, int], str]] = []  # by steps back of the clock, then by time
        expect: list[Happening] = []
        now_ns, steps, (last, last_ns) = 0, 0, ("", -1)
        for row in self._section.rows(self._labelled, "time", "message", "effect"):
            times, message, effects = row.cells
            if effects and (", " in times or " every " in times):
                raise row.fault("an effect of several times")
            if not message and " every " in times:
                raise row.fault("no message")
            for cell in times.split(", "):
                every = _every(cell.removeprefix("back to "), row)
                if (every[0][1] < now_ns) != (cell.startswith("back to ") and message != ""):
                    raise row.fault("not in order of time")
                if every[0][1] < now_ns:
                    steps, last_ns = steps + 1, -1
                now_ns = every[0][1]
                last, last_ns = max((last, last_ns), every[-1], key=lambda each: each[1])
                for time, at_ns in every if message else []:
                    trace.append(((steps, at_ns), self._message(time, message, row)))
            expect += [(now_ns, *self._effect(each, row)) for each in effects.split(", ") if each]
        header = self._labelled.lines[0]
        until, until_ns = _time(header.cells[0].partition(" until ")[2] or f"{last} s", header)
        if any(at_ns > until_ns for at_ns, _, _ in expect):
            raise header.fault("an effect after the end")
        label = self._labelled.label
        heading = self._section.heading.text.lstrip("# ")
        return Timeline(
            f"{heading}, {label}" if label else heading,
            " ".join(takewhile(bool, filter(None, self._prose()))),
            self._rules,
            tuple(text for _, text in sorted(trace, key=lambda each: each[0])),
            until,
            tuple(expect),
            label,
        )

    def _prose(self) -> list[str]:
        """Return the lines that say why: those at the label, or else those of the section."""
        return self._labelled.prose if self._labelled.label else self._section.prose

    def _message(self, time: str, cell: str, row: _Line) -> str:
        """Return a message as a line of a trace."""
        data: dict[str, str] = {}
        topics = set()
        for start, path, value in _fields(cell, row):
            if not start.startswith("/") and start not in self._inputs:
                raise row.fault(f"no input '{start}'")
            topic, within = self._inputs.get(start, (start, ""))
            topics.add(topic)
            data[f"{within}{path}".removeprefix(".")] = value
        if len(topics) != 1 or "" in data:
            raise row.fault("not the fields of one message")
        (topic,) = topics
        if topic in self._common:
            common = self._common[topic]
            given = _fields(common.cells[1], common)
            data = {f"{start}{path}": value for start, path, value in given} | data
        sec, nanosec = divmod(_time(f"{time} s", row)[1], NS_PER_S)
        stamp = f'{{"sec": {sec}, "nanosec": {nanosec}}}'
        fields = ", ".join(
            f'"{path}": {stamp if value == "time" else value}' for path, value in data.items()
        )
        return f'{{"t": "{time}", "topic": "{topic}", "data": {{{fields}}}}}'

    def _effect(self, cell: str, row: _Line) -> tuple[str, str]:
        """Return an action, and what happens to it."""
        action, _, kind = cell.partition(" ")
        if kind not in ("", "reset", "refused") or not re.search(rf"\b{action}\b", self._rules):
            raise row.fault(f"unknown effect '{cell}'")
        return action, kind or "trigger"


def _time(text: str, line: _Line) -> tuple[str, int]:
    """Return the seconds, as text and in nanoseconds."""
    seconds = text.removesuffix(" s")
    at_ns = nanoseconds(seconds)
    if at_ns is None or seconds == text:
        raise line.fault(f"'{text}' is not a time in seconds")
    return seconds, at_ns


def _every(text: str, line: _Line) -> list[tuple[str, int]]:
    """Return each of the times of a cell: one, or those of a range."""
    written = re.fullmatch(r"(.+ s) to (.+ s) every (.+ s)", text)
    if not written:
        return [_time(text, line)]
    (_, first), (_, end), (_, step) = (_time(each, line) for each in written.groups())
    if not 0 < step <= end - first:
        raise line.fault("a range of less than two times")
    return [(_seconds(each), each) for each in range(first, end + 1, step)]


def _seconds(at_ns: int) -> str:
    """Return a time in seconds, without loss."""
    whole, rest = divmod(at_ns, NS_PER_S)
    return f"{whole}.{rest:09}".rstrip("0").rstrip(".")


def _fields(cell: str, row: _Line) -> Iterator[tuple[str, str, str]]:
    """Return the input or topic, the path within it, and the value as JSON, of each field."""
    place = 0
    while place < len(cell):
        target = re.compile(r"(/?\w[\w/]*)((?:\.\w+|\[\d+\])*) = (time)?").match(cell, place)
        if not target:
            raise row.fault("fields are written NAME.PATH = VALUE, and separated by ', '")
        start = end = target.end()
        if not target[3]:
            try:
                _, end = json.JSONDecoder().raw_decode(cell, start)
            except ValueError as error:
                raise row.fault(f"not a value: {error}") from error
        if cell[end : end + 2] not in ("", ", "):
            raise row.fault("values are separated by ', '")
        yield target[1], target[2], target[3] or cell[start:end]
        place = end + 2


GIVEN = read(DIRECTORY / "timelines.md")
MISREAD = read(DIRECTORY / "misread.md")
ALL = [*GIVEN, *(each for path in FILES if path.stem != "timelines" for each in read(path))]
