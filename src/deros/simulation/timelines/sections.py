"""Splits a file of timelines into sections: headings, rules, labels and tables."""

from __future__ import annotations

import re
from collections.abc import Sequence
from dataclasses import dataclass, field
from itertools import takewhile

from deros.diagnostics import Diagnostic, SourceFile
from deros.metamodels.languages import DEROS
from deros.simulation.timelines.lines import Fault, Line, lines_of

COLUMNS = ("time", "message", "effect")
COMMAND = "command"
"""The columns of a timeline, and one more that it may have."""

FIELDS = ("topic", "fields")
"""The columns of a table of what every message of a topic has."""

_FENCE = "```"
_RULE = re.compile(r"`([^`]+)`")
_LABEL = re.compile(r"\*\*(.+?)\.?\*\*")
_PATH = r"(?:\[[^]]*\]\()?([^][()\s]+{})\)?\.?"
_RULES_FILE = re.compile("Rules: *" + _PATH.format(re.escape(DEROS.suffix)))
_TRACE_FILE = re.compile("Trace: *" + _PATH.format(""))


@dataclass
class Labelled:
    """A table and its label, empty for the only one of a section.

    Attributes:
        place: the label, or the heading.
        label: without the full stop.
        prose: the lines below the label.
        rows: the lines of the table.
        trace: the path of the trace that is played with the table.
    """

    place: Line
    label: str
    prose: list[str] = field(default_factory=list)
    rows: list[Line] = field(default_factory=list)
    trace: Line | None = None


@dataclass
class Section:
    """A heading and what stands below it, up to the next one.

    Attributes:
        heading: the line; before the first heading an empty one.
        prose: the lines that are nothing else.
        rules: the statements, one a line.
        file: the path of the rules, where they have a file of their own.
        system: the lines of a system description.
        tables: the timelines.
        fields: the rows of the tables of fields.
        others: the blocks in other languages.
        is_group: whether it contains sections.
        faults: what is wrong in it.
    """

    heading: Line
    prose: list[str] = field(default_factory=list)
    rules: list[Line] = field(default_factory=list)
    file: Line | None = None
    system: list[Line] = field(default_factory=list)
    tables: list[Labelled] = field(default_factory=list)
    fields: list[Line] = field(default_factory=list)
    others: list[Line] = field(default_factory=list)
    is_group: bool = False
    faults: list[Diagnostic] = field(default_factory=list)

    @property
    def level(self) -> int:
        """The level of the heading; 0 before the first one."""
        text = self.heading.text
        return len(text) - len(text.lstrip("#"))

    @property
    def name(self) -> str:
        """The text of the heading."""
        return self.heading.text.lstrip("# ")

    @property
    def is_played(self) -> bool:
        """Whether it has timelines, and is not prose alone."""
        return any(each.rows for each in self.tables)


def sections_of(source: SourceFile) -> list[Section]:
    """Split a file at its headings; each fault is stored in its section."""
    reader = _Reader(source)
    reader.read()
    return reader.sections


class _Reader:
    def __init__(self, source: SourceFile) -> None:
        self._lines = lines_of(source)
        self._next = 0
        self.sections = [Section(self._lines[0].part(0, 0))]

    @property
    def _section(self) -> Section:
        return self.sections[-1]

    def read(self) -> None:
        """Read all lines."""
        while self._next < len(self._lines):
            line = self._lines[self._next]
            try:
                self._take(line)
            except Fault as fault:
                self._section.faults.append(fault.diagnostic)

    def _take(self, line: Line) -> None:
        """Read what begins at a line."""
        self._next += 1
        section = self._section
        if line.text.startswith("#"):
            self.sections.append(Section(line))
            _nest(self.sections)
        elif line.text.startswith(_FENCE):
            self._block(section, line)
        elif line.text.startswith("|"):
            self._table(section, line)
        elif written := _RULES_FILE.fullmatch(line.text):
            _name_rules(section, line, line.part(*written.span(1)))
        elif written := _TRACE_FILE.fullmatch(line.text):
            _name_trace(section, line, line.part(*written.span(1)))
        elif section.level > 1 and _RULE.fullmatch(line.text):
            if section.is_played:
                raise line.fault("rules below the table")
            section.rules.append(line.part(1, len(line.text) - 1))
        elif section.level > 1 and (label := _LABEL.match(line.text)):
            _label(section, label, line)
        else:
            (section.tables[-1].prose if section.tables else section.prose).append(line.text)

    def _block(self, section: Section, line: Line) -> None:
        """Read a fenced block up to its end."""
        rest = self._lines[self._next :]
        inside = list(takewhile(lambda each: each.text != _FENCE, rest))
        language = line.text.removeprefix(_FENCE)
        self._next += len(inside) + 1
        if len(inside) == len(rest):
            known = language in ("deros", "rossystem")
            reason = "that is never closed" + ("" if known else ", and not one of ```deros")
            raise line.fault(f"a block {reason}", "write ``` on a line of its own below it")
        if language == "deros":
            block = section.rules
        elif language == "rossystem" and section.level < 2:
            block = section.system
        else:
            section.others.append(line)
            return
        if block:
            hint = "a section has its rules in one block"
            raise line.fault("a second block, or not one of ```deros", hint)
        block += inside

    def _table(self, section: Section, first: Line) -> None:
        """Read a table up to its last row."""
        rest = self._lines[self._next :]
        rows = [first, *takewhile(lambda each: each.text.startswith("|"), rest)]
        self._next += len(rows) - 1
        behind = rest[len(rows) - 1] if len(rows) <= len(rest) else None
        head = [each.text for each in first.cells]
        if tuple(head) == FIELDS and section.level < 2:
            section.fields += checked_rows(rows, FIELDS)
        elif not _is_timeline(head):
            if section.is_played and not (len(rows) > 1 and rows[1].is_rule):
                hint = "remove the empty line above it"
                raise first.fault("a row apart from its table", hint)
        else:
            self._timeline(section, rows)
            if behind is not None and behind.text and not behind.text.startswith("#"):
                self._next += 1
                if "|" in behind.text:
                    raise behind.fault("a row does not have the cells of its table", _CELLS)
                text = "neither a row of the table above nor apart from it"
                raise behind.fault(text, "leave an empty line between them")

    def _timeline(self, section: Section, rows: list[Line]) -> None:
        if not section.tables:
            section.tables.append(Labelled(section.heading, ""))
        table = section.tables[-1]
        if table.rows:
            hint = "give each table its label above it: '**As meant.**'"
            raise rows[0].fault("a second table without a label", hint)
        table.rows = rows


def _is_timeline(head: Sequence[str]) -> bool:
    """Return whether the head of a table is that of a timeline, one of its names misspelt."""
    if not head or len(head) > len(COLUMNS) + 1:
        return False
    names = {head[0].split(" until ")[0], *head[1:]}
    return len(names & set(COLUMNS)) >= len(COLUMNS) - 1


def _label(section: Section, label: re.Match[str], line: Line) -> None:
    if section.tables and not all(each.label for each in section.tables):
        raise line.fault("a label below a table without one", "give the first table a label, too")
    if any(each.label == label[1] for each in section.tables):
        raise line.fault("a second table of this label", "give each table a label of its own")
    prose = [line.text[label.end() :].strip()]
    section.tables.append(Labelled(line, label[1], prose))


def _name_rules(section: Section, line: Line, path: Line) -> None:
    """Note the file of the rules."""
    if section.level > 1:
        raise line.fault("the rules of a file stand below its title", "move the line up")
    if section.file is not None:
        raise line.fault("a second file of rules", "begin a second title: '# Title'")
    section.file = path


def _name_trace(section: Section, line: Line, path: Line) -> None:
    """Note the trace of the table that follows."""
    if not section.tables:
        section.tables.append(Labelled(section.heading, ""))
    table = section.tables[-1]
    if table.trace is not None or table.rows:
        raise line.fault("a trace stands once, above its table")
    table.trace = path


def _nest(sections: list[Section]) -> None:
    """Make the section around the last one a group, if the last one is in one."""
    last = sections[-1]
    if last.level < 3:
        return
    above = next((each for each in reversed(sections[:-1]) if each.level < 3), sections[0])
    is_group = above.level == 2 and not above.rules and not above.tables
    if last.level == 3 and is_group:
        above.is_group = True


def nesting_fault(sections: Sequence[Section], section: Section) -> Fault | None:
    """Return what is wrong with the level of a section that has timelines."""
    if section.level > 3:
        return section.heading.fault("a heading above a timeline is of level 1 to 3")
    before = sections[: next(n for n, each in enumerate(sections) if each is section)]
    above = next((each for each in reversed(before) if each.level < 3), None)
    if section.level == 3 and not (above is not None and above.is_group):
        text = "a heading of level 3 is in a group, below one of level 2"
        return section.heading.fault(text, "write '##'")
    return None


_CELLS = "a row is | 1 s | speed = 0.6 | stop |, with as many cells as the head of the table"


def checked_rows(rows: list[Line], columns: Sequence[str]) -> list[Line]:
    """Return the rows below the names of the columns, the first of which may go on.

    Raises:
        Fault: a line does not have the cells, or the names are others.
    """
    for place, line in enumerate(rows):
        if not line.text.endswith("|") or len(line.cells) != len(columns):
            raise line.fault(f"not the cells | {' | '.join(columns)} |", _CELLS)
        if (place == 1) != line.is_rule:
            text = "|---| belongs below the names of the columns, and only there"
            raise line.fault(text)
    first, *others = (each.text for each in rows[0].cells)
    if (first.split(" until ")[0], *others) != tuple(columns):
        raise rows[0].fault(f"the columns are not | {' | '.join(columns)} |")
    if len(rows) < 2:
        raise rows[0].fault("|---| belongs below the names of the columns, and only there")
    return rows[2:]
