"""The timelines of a file as they are written: the rules and the table of each.

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

Rules of more than two lines are in a block ``deros``. Without rules, a timeline has those of the
timeline before it.

A timeline may have several tables, each below its label, text in bold at the start of a line. They
are timelines of their own, of the same rules: ``**Sensor lost: it never comes.** Then why.``
Timelines may also have headings of level 3, in groups with headings of level 2.

Below a heading of level 1, or before all headings, may stand what is common to the timelines that
follow: a line ``Rules: [robot.deros](robot.deros)`` that names their rules; or statements, of which
a timeline has only those inputs and constants that its rules name and do not declare; and a table
``| topic | fields |`` of fields that every message of a topic has. Statements of a timeline replace
common ones of the same name. A block ``rossystem`` there is the system that the rules use.
A timeline that stands there itself has all of the statements. Without any rules, those are meant
that stand beside the file, under its name. What the cells mean is said in
:mod:`deros.simulation.timelines.cells`.
"""

from __future__ import annotations

import operator
import re
from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from itertools import dropwhile, takewhile
from pathlib import PurePath

from deros.diagnostics import Diagnostic, SourceFile, Span
from deros.metamodels.languages import DEROS
from deros.simulation.timelines.lines import Fault, Line
from deros.simulation.timelines.sections import (
    COLUMNS,
    COMMAND,
    Labelled,
    Section,
    checked_rows,
    nesting_fault,
    sections_of,
)

_DECLARED = re.compile(r"(input|const|action) (\w+)")
_USED = re.compile(r'\buse +"([^"]*)"')


@dataclass(frozen=True, slots=True)
class RulesFile:
    """Rules in a file of their own.

    Attributes:
        path: relative to the folder of the timelines.
        span: the place that names it.
        is_implied: whether it is meant by its name alone.
    """

    path: str
    span: Span
    is_implied: bool = False


@dataclass(frozen=True)
class RulesText:
    """Rules that stand beside their timelines.

    Attributes:
        text: the statements.
        source: the same in their places: the file without all else.
        system: the description of the system, likewise, if it stands in the file.
        system_path: the name under which the rules use it.
    """

    text: str
    source: SourceFile
    system: SourceFile | None = None
    system_path: str = ""


@dataclass(frozen=True)
class Case:
    """A timeline as it is written.

    Attributes:
        name: the heading, and the label of the table if it has one.
        why: the prose at the table.
        rules: the rules that it is about.
        head: the line with the names of the columns.
        rows: the lines below them.
        fields: the rows that list the fields of every message of a topic, by topic.
        place: the label, or the heading.
        label: that of the table, without the full stop.
        trace: the path of a trace that is played with the table.
    """

    name: str
    why: str
    rules: RulesFile | RulesText
    head: Line
    rows: tuple[Line, ...]
    fields: Mapping[str, Line]
    place: Line
    label: str = ""
    trace: Line | None = None

    @property
    def has_commands(self) -> bool:
        """Whether it says what the gates publish."""
        return len(self.head.cells) > len(COLUMNS)


@dataclass(frozen=True, slots=True)
class Document:
    """The timelines of a file, and what is wrong with it."""

    cases: tuple[Case, ...]
    diagnostics: tuple[Diagnostic, ...]


def read_document(source: SourceFile) -> Document:
    """Read the timelines of a file; each faulty section is reported, and left out."""
    reader = _Reader(source)
    sections = sections_of(source)
    for section in sections:
        reader.take(sections, section)
    if not reader.cases and not reader.diagnostics:
        hint = "a timeline is a table with the head | time | message | effect |"
        reader.diagnostics.append(sections[0].heading.fault("no timeline", hint).diagnostic)
    return Document(tuple(reader.cases), tuple(reader.diagnostics))


def has_timelines(source: SourceFile) -> bool:
    """Return whether a file of Markdown has timelines, or means to."""
    return any(each.is_played or each.file is not None for each in sections_of(source))


class _Reader:
    def __init__(self, source: SourceFile) -> None:
        self._source = source
        self._common: list[Line] = []
        self._system: SourceFile | None = None
        self._fields: dict[str, Line] = {}
        self._file: RulesFile | None = None
        self._rules: RulesText | None = None  # of the last timeline
        self.cases: list[Case] = []
        self.diagnostics: list[Diagnostic] = []

    def take(self, sections: list[Section], section: Section) -> None:
        """Read the next section; a fault is stored."""
        try:
            self._take(sections, section)
        except Fault as fault:
            self.diagnostics.append(fault.diagnostic)

    def _take(self, sections: list[Section], section: Section) -> None:
        self.diagnostics += section.faults
        if section.level < 2:
            self._begin(section)
        if section.is_group or not (section.is_played or (section.level > 1 and section.rules)):
            return
        if section.faults:
            return
        if fault := nesting_fault(sections, section):
            raise fault
        if section.others:
            raise section.others[0].fault("a block in a timeline that is not one of ```deros")
        rules = self._rules_of(section)
        if not section.tables:
            raise section.heading.fault("a timeline without a table")
        for each in section.tables:
            self.cases.append(self._case(section, each, rules))

    def _begin(self, section: Section) -> None:
        """Note what is common to the timelines that follow."""
        has_title = section.level == 1
        if has_title or section.file is not None:
            self._file = None
        if section.file is not None:
            self._file = RulesFile(section.file.text, section.file.span)
        if has_title or section.rules:
            self._common, self._rules = section.rules, None
        if section.system:
            self._system = _in_place(self._source, section.system)
        if has_title or section.fields:
            self._fields = {each.cells[0].text: each for each in section.fields}

    def _rules_of(self, section: Section) -> RulesFile | RulesText:
        if self._file is not None:
            if rules := (self._common or section.rules):
                hint = "write them there, or leave out the line 'Rules:'"
                raise rules[0].fault(f"rules beside those of '{self._file.path}'", hint)
            return self._file
        if section.level > 1 and section.rules:
            self._rules = self._text([*_needed(self._common, section.rules), *section.rules])
        elif section.level < 2 and section.rules:
            self._rules = self._text(section.rules)
        if self._rules is not None:
            return self._rules
        path = PurePath(self._source.path).with_suffix(DEROS.suffix).name
        return RulesFile(path, section.heading.span, is_implied=True)

    def _text(self, lines: list[Line]) -> RulesText:
        text = "\n".join([*(each.text for each in lines), ""])
        used = _USED.search(text)
        system = self._system if used else None
        source = _in_place(self._source, lines)
        return RulesText(text, source, system, used[1] if used else "")

    def _case(self, section: Section, labelled: Labelled, rules: RulesFile | RulesText) -> Case:
        if not labelled.rows:
            text = "a label without a table" if labelled.label else "a trace without a table"
            raise labelled.place.fault(text, "leave an empty line between them, and begin with |")
        head = labelled.rows[0]
        has_commands = bool(head.cells) and head.cells[-1].text == COMMAND
        rows = checked_rows(labelled.rows, (*COLUMNS, COMMAND) if has_commands else COLUMNS)
        name = section.name or PurePath(self._source.path).stem
        prose = labelled.prose if labelled.label else section.prose
        return Case(
            f"{name}, {labelled.label}" if labelled.label else name,
            " ".join(takewhile(bool, dropwhile(operator.not_, prose))),
            rules,
            head,
            tuple(rows),
            self._fields,
            labelled.place,
            labelled.label,
            labelled.trace,
        )


def _needed(common: list[Line], own: list[Line]) -> list[Line]:
    """Return the common statements that the rules of a timeline need."""
    rules = "\n".join(each.text for each in own)

    def is_needed(statement: Line) -> bool:
        others = [each.text for each in common if each is not statement]
        declared = _DECLARED.match(statement.text)
        if not declared:
            return True
        if re.search(rf"\b{declared[0]}\b", rules):
            return False
        if declared[1] == "action":
            return any(re.search(rf"\b{declared[2]}\b", each) for each in (rules, *others))
        named = rf"(?<![\w./])(?<!\d ){declared[2]}\b(?!:)"  # neither a unit nor a rule
        return re.search(named, rules) is not None

    return list(filter(is_needed, common))


def _in_place(source: SourceFile, lines: Iterable[Line]) -> SourceFile:
    """Return a file with some of its lines alone, so that findings in them have their places."""
    texts = [""] * (source.text.count("\n") + 1)
    for each in lines:
        indent = each.start - source.text.rfind("\n", 0, each.start) - 1
        texts[each.number - 1] = " " * indent + each.text
    return SourceFile(source.path, "\n".join(texts))
