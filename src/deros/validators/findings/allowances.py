"""Findings that the author of a model allows, each with the reason beside it.

A comment ``// deros: allow DRS210 the driver is started by hand`` at the end of a line silences the
findings of that code on that line. A comment that stands alone holds for the next line that is
neither empty nor a comment. Errors cannot be allowed: generators and commands
rely on error-free models. A project allows findings by code and path: :class:`ProjectAllowance`.
"""

from __future__ import annotations

import re
from bisect import bisect_left
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass

from deros import codes
from deros.diagnostics import Code, Diagnostic, Severity, SourceFile, Span, report
from deros.metamodels.load import LoadedFile
from deros.metamodels.reading import DIRECTIVE, comments
from deros.names.names import near
from deros.validators.findings.allowed import Allowance, Allowed, ProjectAllowance
from deros.validators.findings.hints import did_you_mean, unknown_code

_WORD = re.compile(r"[^\s,:]+")
_CODE = re.compile(r"(?i)DRS[-_]?\d+")
_SEPARATOR = re.compile(r"\s*(,)?\s*")
_FILLING = " \t\r\n:;,.-*/\N{EN DASH}\N{EM DASH}"
_USAGE = "write '// deros: allow CODE reason'"

ABOUT_ALLOWANCES = frozenset({codes.BAD_ALLOWANCE, codes.NOT_ALLOWABLE, codes.UNUSED_ALLOWANCE})
"""Findings about allowances, which cannot be allowed themselves."""


@dataclass(frozen=True, slots=True)
class Outcome:
    """The findings that remain, and those that are allowed."""

    findings: tuple[Diagnostic, ...]
    allowed: tuple[Allowed, ...]


def apply_allowances(
    findings: Iterable[Diagnostic],
    loaded: Iterable[LoadedFile],
    judged: Iterable[LoadedFile],
    project: Sequence[ProjectAllowance] = (),
) -> Outcome:
    """Split findings into remaining and allowed ones, and check the allowances.

    Args:
        findings: all findings of a run.
        loaded: its files.
        judged: those of them that were checked as the user named them. Only in these an allowance
            may be called unnecessary: a file that another one imports is checked in part.
        project: what the project's file allows.
    """
    standing: list[Diagnostic] = []
    allowed: list[Allowed] = []
    said: list[Diagnostic] = []
    given: dict[tuple[SourceFile, int, str], Allowance] = {}
    for each in loaded:
        if each.source is not None:
            allowances, wrong = read_allowances(each.source)
            said += wrong
            given |= {(each.source, one.line, one.code): one for one in allowances}
    needed: set[Span] = set()
    broken = False
    for finding in findings:
        broken = broken or finding.is_error
        by = _allowance_of(finding, given, project)
        if by is None:
            standing.append(finding)
        else:
            allowed.append(Allowed(finding, by))
            needed.add(by.span)
    if not broken:  # an error may be the reason why another finding has not come up
        sources = {each.source for each in judged}
        unneeded = [a for a in given.values() if a.span not in needed and a.span.source in sources]
        said += map(_unneeded, unneeded)
    return Outcome((*standing, *said), tuple(allowed))


def _allowance_of(
    finding: Diagnostic,
    given: dict[tuple[SourceFile, int, str], Allowance],
    project: Sequence[ProjectAllowance],
) -> Allowance | ProjectAllowance | None:
    if finding.is_error or (not given and not project):
        return None
    span = finding.span
    beside = given.get((span.source, span.line, finding.code.name)) if given else None
    return beside or next((each for each in project if each.covers(finding)), None)


def _unneeded(allowance: Allowance) -> Diagnostic:
    name = allowance.span.text
    message = f"line {allowance.line} has no finding {name} to allow"
    return report(codes.UNUSED_ALLOWANCE, message, allowance.span, f"remove {name}")


# Reading comments --------------------------------------------------------------------------------


def read_allowances(source: SourceFile) -> tuple[list[Allowance], list[Diagnostic]]:
    """Return the allowances in the comments of a text, and what is wrong with them."""
    if DIRECTIVE.search(source.text) is None:
        return [], []
    every = list(comments(source))
    ours = [(span, mark) for span in every if (mark := DIRECTIVE.match(span.text))]
    allowances: list[Allowance] = []
    wrong: list[Diagnostic] = []
    code = _lines_of_code(every) if ours else []
    for span, mark in ours:
        following = bisect_left(code, span.line)
        line = code[following] if following < len(code) else span.line
        for result in _read(Span(source, span.start + mark.end(), _end(span)), line):
            if isinstance(result, Allowance):
                allowances.append(result)
            else:
                wrong.append(result)
    return allowances, wrong


def _end(comment: Span) -> int:
    """Return where the words of a comment end."""
    return comment.end - (2 if comment.text.startswith("/*") else 0)


def _read(rest: Span, line: int) -> Iterator[Allowance | Diagnostic]:
    """Read what follows ``deros:`` in a comment."""
    source, text = rest.source, rest.text
    verb = _WORD.match(text)
    if verb is None or verb[0] != "allow":
        place = Span(source, rest.start, rest.start + (verb.end() if verb else 0))
        hint = did_you_mean(verb[0], ["allow"], _USAGE) if verb else _USAGE
        message = "a comment that begins with 'deros:' must be an allowance"
        yield report(codes.BAD_ALLOWANCE, message, place, hint)
        return
    named, at = _named_codes(rest, verb.end())
    if not named:
        message = "an allowance must name the code of the finding"
        yield report(codes.BAD_ALLOWANCE, message, _first(rest, verb.end()), _USAGE)
        return
    reason = " ".join(text[at:].strip(_FILLING).split())
    if not re.search(r"\w", reason):
        message = "an allowance must give the reason why the finding is acceptable"
        hint = f"write '// deros: allow {named[0].text} reason'"
        yield report(codes.BAD_ALLOWANCE, message, Span(source, named[0].start, rest.end), hint)
        return
    for span in named:
        code = allowable(span.text, span)
        yield Allowance(code.name, line, reason, span) if isinstance(code, Code) else code


def _named_codes(rest: Span, at: int) -> tuple[list[Span], int]:
    """Return the positions of the codes that follow, and where they end.

    Behind a code without a comma only another ``DRS210`` is a code: the reason may well begin with
    a word that is a slug.
    """
    named: list[Span] = []
    text = rest.text
    at += len(text[at:]) - len(text[at:].lstrip())
    is_listed = True
    while word := _WORD.match(text, at):
        if not (_CODE.fullmatch(word[0]) or (is_listed and _is_slug(word[0]))):
            break
        named.append(Span(rest.source, rest.start + at, rest.start + word.end()))
        separator = _SEPARATOR.match(text, word.end())
        assert separator is not None
        at, is_listed = separator.end(), separator[1] is not None
    return named, at


def _is_slug(word: str) -> bool:
    """Return whether a word is a slug, or probably meant to be one."""
    spelled = word.lower().replace("_", "-")
    return spelled in codes.SLUGS or ("-" in spelled and bool(near(spelled, codes.SLUGS)))


def allowable(name: str, span: Span) -> Code | Diagnostic:
    """Return the code with a name or slug, or the finding that it cannot be allowed in a model."""
    code = codes.find(name)
    if code is None:
        message = f"there is no diagnostic '{name}'"
        return report(codes.NOT_ALLOWABLE, message, span, unknown_code(name))
    if code.severity is Severity.ERROR:
        message = f"{name} ({code.title}) is an error, and errors cannot be allowed"
        return report(codes.NOT_ALLOWABLE, message, span, "correct what it reports")
    if code in ABOUT_ALLOWANCES or code not in codes.OF_MODELS:
        message = f"{name} ({code.title}) is not about the content of a model"
        return report(codes.NOT_ALLOWABLE, message, span, "remove the allowance")
    return code


def _first(rest: Span, at: int) -> Span:
    word = _WORD.search(rest.text, at)
    start, end = (word.start(), word.end()) if word else (at, at)
    return Span(rest.source, rest.start + start, rest.start + end)


def _lines_of_code(comments_of_file: Sequence[Span]) -> list[int]:
    """Return the lines that hold anything but blanks and comments."""
    source = comments_of_file[0].source
    pieces, done = [], 0
    for span in comments_of_file:
        pieces += [source.text[done : span.start], "\n" * span.text.count("\n")]
        done = span.end
    text = "".join([*pieces, source.text[done:]])
    return [number for number, line in enumerate(text.split("\n"), start=1) if line.strip()]
