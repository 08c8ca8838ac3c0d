"""Habits of other languages: how to rewrite a text that does not parse.

Each row has a pattern for the text at the fault, if need be one for the text before it, what to
write instead, and words. A row is offered only if the statement parses on with its edit.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Iterator
from dataclasses import dataclass

from deros.metamodels.languages import DEROS, ROSNODE, ROSSYSTEM, Language
from deros.metamodels.recovery.container_habits import CONTAINER_HABITS
from deros.metamodels.recovery.edits import (
    NUMBER,
    in_quotes,
    interval,
    lower,
    ramp,
    value_of_argument,
)
from deros.metamodels.recovery.element_habits import ELEMENT_HABITS
from deros.metamodels.recovery.node_habits import NODE_HABITS
from deros.metamodels.recovery.program_habits import PROGRAM_HABITS

_LOOK_AROUND = 400
"""Characters before a fault where a pattern may begin; behind it, a pattern ends twice as far away
at most. Each row is looked for at each fault: the time for one must not grow with the text."""

Languages = tuple[Language, ...]
_Edit = Callable[[re.Match[str]], str]


@dataclass(frozen=True, slots=True)
class Habit:
    """A recognised habit: the edit, ``text`` in place of ``start`` to ``end``, and its messages.

    ``text`` is ``None`` where no edit can be given; ``reads_as`` is what a parser reads for it, if
    it is a comment.
    """

    start: int
    end: int
    text: str | None
    hint: str
    message: str = ""
    reads_as: str | None = None


@dataclass(frozen=True, slots=True)
class _Row:
    r"""One habit.

    Attributes:
        pattern: of the text; the fault lies where its group ``at`` begins, or the whole match.
        text: what to write instead of the match, with its groups as ``\g<name>``; ``None`` if
            that is unknown.
        hint: in words, with the groups likewise, or a function that returns them.
        message: what is wrong, if the words for any syntax error do not say it.
        languages: those that have the habit; none for all.
        reads_as: what a parser reads for ``text``, if that is a comment.
    """

    pattern: re.Pattern[str]
    text: str | _Edit | None
    hint: str | _Edit
    message: str = ""
    languages: Languages = ()
    reads_as: str | None = None

    def words(self, match: re.Match[str]) -> str:
        """Return the hint for a match."""
        return match.expand(self.hint) if isinstance(self.hint, str) else self.hint(match)

    def edit(self, match: re.Match[str]) -> str | None:
        """Return what to write instead of a match."""
        if self.text is None or isinstance(self.text, str):
            return None if self.text is None else match.expand(self.text)
        return self.text(match)


def _row(
    pattern: str,
    text: str | _Edit | None,
    hint: str | _Edit = "",
    message: str = "",
    languages: Languages = (),
    reads_as: str | None = None,
) -> _Row:
    """Return a row; without a hint, it says to write ``text``."""
    if not hint and isinstance(text, str):
        hint = f"write '{text.strip()}'"
    return _Row(re.compile(pattern), text, hint, message, languages, reads_as)


_NODE, _SYSTEM, _RULES = (ROSNODE,), (ROSSYSTEM,), (DEROS,)
_CHOICES = _RULES + _SYSTEM
"""The languages that have conditions."""
_UNIT = r"(?:[ ]*(?!(?:or|and|not|for|then|in)\b)[A-Za-z][\w/^]*)?"
_TERM_BEGINS = r"(?<![\w.+*/-])(?<![+*/-] )"
"""The lower bound of ``y`` is ``x - 1`` in ``x - 1 < y < 3``, not 1."""
_OPERAND = r"[A-Za-z/][\w/.]*(?:\(\))?"
_UPPER = "keywords are lower case"
_COMMENT = "a comment begins with '//'"
_ELSE = "write a separate 'if' with its own condition: behaviours are independent"
_NO_ELSE = "rules have no 'else'"

_ROWS = (
    # Characters
    _row(
        '[\u201c\u201d\u201e\u00ab](?P<said>[^"\u201c\u201d\u201e\u00ab\u00bb\n]*)[\u201c\u201d\u00bb]',
        r'"\g<said>"',
        "write plain quotes: '\"'",
        "typographic quotes do not delimit strings",
    ),
    _row(
        r"'(?P<said>[^'\"\n]*)'",
        r'"\g<said>"',
        "write double quotes: '\"'",
        "strings are written in double quotes",
    ),
    _row("[\u00a0\u2002-\u200a\u202f\u3000]+", " ", "write a plain space"),
    _row("[\u2010-\u2014\u2212]", "-", "write a plain '-'"),
    _row("\u2264", "<="),
    _row("\u2265", ">="),
    _row("\u2260", "!="),
    _row("\u2192", "->", languages=_RULES),
    _row("\u2192", "to", languages=_SYSTEM),
    *(_row(*each, _RULES) for each in ELEMENT_HABITS),
    # Comments
    _row(
        r"#+(?P<said>[^\n]*)", r"//\g<said>", _COMMENT, "'#' does not begin a comment here", (), " "
    ),
    _row(
        r"--(?P<said> [^\n]*)",
        r"//\g<said>",
        _COMMENT,
        "'--' does not begin a comment here",
        (),
        " ",
    ),
    _row(
        r"<!--(?P<said>[^\n]*?)-->",
        r"/*\g<said>*/",
        "write comments between '/*' and '*/'",
        "'<!--' does not begin a comment here",
        (),
        " ",
    ),
    # Conditions
    _row(r"\|\|?", " or ", languages=_CHOICES),
    _row(r"&&?", " and ", languages=_CHOICES),
    _row(r"!\s*in\b", "not in", languages=_RULES),
    _row(r"!(?!=)", "not ", languages=_CHOICES),
    _row(r"~(?=\w)", "not ", languages=_RULES),
    _row(r"OR\b|Or\b", "or", f"write 'or': {_UPPER}", languages=_CHOICES),
    _row(r"AND\b|And\b", "and", f"write 'and': {_UPPER}", languages=_CHOICES),
    _row(r"\b(?:AND|And)\s+(?P<at>)", "and ", f"write 'and': {_UPPER}", languages=_CHOICES),
    _row(r"\b(?:OR|Or)\s+(?P<at>)", "or ", f"write 'or': {_UPPER}", languages=_CHOICES),
    _row(r"\b(?:NOT|Not)\s+(?P<at>)", "not ", f"write 'not': {_UPPER}", languages=_CHOICES),
    _row(r"===", "=", languages=_CHOICES),
    _row(r"==(?P<at>)=", "=", languages=_CHOICES),
    _row(r"<(?P<at>)>", "!=", languages=_CHOICES),
    _row(r"~=|/=", "!=", languages=_CHOICES),
    _row(r":=", "=", languages=_RULES),
    _row(r"<-", "=", languages=_RULES),
    _row(r"=(?P<at>)>\s*(?=\{)", "then ", languages=_RULES),
    _row(r"=(?P<at>)(?P<sign>[<>])", r"\g<sign>=", languages=_CHOICES),
    _row(
        r"(?<! )[ ]+(?P<at>)is\s+(?:null|None|nan|missing)\b",
        ".missing()",
        languages=_RULES,
    ),
    _row(r"is\s+not\b", "!=", languages=_CHOICES),
    _row(r"is\b", "=", languages=_CHOICES),
    _row(r"(?:equals|eq)\b", "=", languages=_CHOICES),
    _row(r"in\s+(?P<at>)not\b", "not in", languages=_RULES),
    _row(r"between\b", "in", languages=_RULES),
    _row(
        rf"{_TERM_BEGINS}(?P<low>{NUMBER}{_UNIT})\s*(?P<first><=?)\s*(?P<name>{_OPERAND})\s*"
        rf"(?P<at>)(?P<last><=?)\s*(?P<high>{NUMBER}{_UNIT})",
        interval,
        "write it as an interval: '{edit}'",
        "a comparison has two sides",
        _RULES,
    ),
    _row(
        r"(?<!\s)\s*(?P<at>)\.\.+\s*",
        ", ",
        "write ',' between the bounds",
        languages=_RULES + _NODE,
    ),
    _row(r"(?<!\s)\s+to\s+(?P<at>)", ", ", "write ',' between the bounds", languages=_RULES),
    # Behaviours
    _row(r"(?::|->|do\b)\s*(?=\{)", " then ", languages=_RULES),
    _row(
        r"(?P<call>[a-z_]\w*(?:\([^()\n]*\))?)(?:[ \t\r]*;)?(?=[ \t\r]*(?:\n|\Z))",
        r"{ \g<call>; }",
        "write actions in braces",
        "the actions of a behaviour are written in braces",
        _RULES,
    ),
    _row(r"when\b|whenever\b", "if", languages=_RULES),
    _row(r"(?:else\s+if|elif|elsif|elseif)\b", "if", _ELSE, _NO_ELSE, _RULES),
    _row(r"else\b", None, _ELSE, _NO_ELSE, _RULES),
    _row(
        rf"then\s+(?P<at>)(?P<hold>for\s+{NUMBER}{_UNIT})",
        r"\g<hold> then",
        "write the duration before 'then'",
        "",
        _RULES,
    ),
    _row(
        rf"\bzero(?:\s+ramp)?\s+(?P<at>)(?:(?:at|by|with)\s+)?"
        rf"(?P<rate>{NUMBER}\s*(?P<unit>[A-Za-z%°][\w°]*(?:[*/^][\w°]+)*))",
        None,
        ramp,
        "a ramp to zero is of fields that it names",
        _RULES,
    ),
    _row(
        rf"\bzero(?:\s+ramp)?\s+(?P<at>)(?:within|over|in|after)\s+{NUMBER}(?P<unit>)(?P<rate>)",
        None,
        ramp,
        "a ramp to zero is of fields that it names, each with its rate instead of a duration",
        _RULES,
    ),
    _row(
        rf"(?P<ramps>\bramp\s[^;:{{}}]*?)\s(?P<word>at|by|to|with)\s+(?P<at>)(?={NUMBER})",
        r"\g<ramps> ",
        r"remove '\g<word>'",
        "the rate of a ramp stands directly behind its field",
        _RULES,
    ),
    _row(
        r"until\b",
        None,
        "'for T' at the end requires the condition to hold for that long",
        "rules have no 'until'",
        _RULES,
    ),
    _row(
        rf"(?P<hold>for\s+{NUMBER}\s*(?:ns|us|ms|sec|s|min|h)\b)\s*(?P<what>[^;{{}}\n]+)",
        r"\g<what> \g<hold>",
        "write the duration after the condition: 'CONDITION for T'",
        "",
        _RULES,
    ),
    _row(r"(?:let|var|define|val)\b", "const", languages=_RULES),
    _row(
        r"\b(?P<whole>\d+)\s*(?P<at>),(?P<part>\d+)\b",
        r"\g<whole>.\g<part>",
        r"write '\g<whole>.\g<part>'",
        "decimals are written with a point",
    ),
    _row(r"to\b", "on", languages=_RULES),
    _row(r"to\b", "->", languages=_RULES),
    _row(r"import\b(?=\s*\")", None, "write 'use \"FILE.system\" import NAME'", "", _RULES),
    # Names, types, texts
    _row(
        r"(?P<package>\w+)::(?:(?P<kind>msg|srv|action)::)?(?P<name>\w+)",
        r"\g<package>.\g<name>",
        r"write '\g<package>.\g<name>'",
        "the parts of a type are joined by '.'",
    ),
    _row(r'"(?P<name>[/~]?\w[\w/]*)"', r"\g<name>", "write the name without quotes"),
    _row(r"(?P<name>[\w./*-]+\.(?:rnd|system))\b", r'"\g<name>"', "write the file in quotes"),
    _row(
        r"(?P<head>best|sensor|keep|transient|system|manual|read|log)-(?P<tail>\w+)",
        r"\g<head>_\g<tail>",
    ),
    _row(
        r"(?P<word>BEST_EFFORT|RELIABLE|TRANSIENT_LOCAL|VOLATILE|KEEP_ALL|SENSOR_DATA)\b",
        lower,
        _UPPER,
    ),
    _row(r"(?:yes|on|True|TRUE)\b", "true"),
    _row(r"(?:no|off|False|FALSE)\b", "false"),
    # Node descriptions
    *(_row(*each, _NODE) for each in NODE_HABITS),
    _row(r"params\b", "parameters"),
    _row(
        r":\s*(?P<at>)(?P<name>[A-Z]\w*)(?![\w./:])",
        None,
        r"write the package before the name: 'PACKAGE.\g<name>'",
        languages=_NODE + _SYSTEM,
    ),
    _row(
        r"[-=+*/(\[,]\s*(?P<at>)(?P<word>[A-Za-z_]\w*)(?![\w.(/])",
        value_of_argument,
        r"write '$\g<word>' for the value of the argument",
        languages=_SYSTEM,
    ),
    _row(
        r"=\s*(?P<at>)(?!(?:from\s+)?xacro\s+[\"$])(?P<word>[A-Za-z_][\w/]*)(?![\w.(])",
        r'= "\g<word>"',
        r"""write '"\g<word>"': strings are written in quotes""",
        languages=_NODE + _SYSTEM,
    ),
    # Programs
    *(_row(*each, _SYSTEM) for each in PROGRAM_HABITS),
    *(_row(*each, _SYSTEM) for each in CONTAINER_HABITS),
    # Arguments of systems
    _row(r"\$\((?:var|arg)\s+(?P<name>[A-Za-z_]\w*)\s*\)", r"$\g<name>", languages=_SYSTEM),
    _row(r"\$\{(?P<name>[A-Za-z_]\w*)\}(?![\w/~${])", r"$\g<name>", languages=_SYSTEM),
    _row(
        r"\$(?![\w{(])",
        None,
        "write the name of an argument directly behind '$': '$speed'",
        languages=_SYSTEM,
    ),
    _row(r"=(?P<at>)=", "=", languages=_SYSTEM),
    *(
        _row(
            rf"(?:(?<=to )|(?<=topic )|(?<=namespace )){pattern}",
            in_quotes,
            "write '{edit}'",
            "text with the values of arguments in it stands in quotes",
            _SYSTEM,
        )
        for pattern in (
            r"[\w/~]*(?P<at>)\$\{?[A-Za-z_][\w/~${}]*",
            r"\$[A-Za-z_]\w*(?P<at>)/[\w/~${}]*",
        )
    ),
    _row(
        r"(?<![\w$])(?P<name>\$?[A-Za-z_]\w*)\s+(?P<at>)not\s+in\b",
        r"not \g<name> in",
        languages=_SYSTEM,
    ),
    _row(r"\bif\s+(?P<at>)", "when ", "write 'when'", languages=_SYSTEM),
    _row(r"\bunless\s+(?P<at>)", "when not ", "write 'when not'", languages=_SYSTEM),
    _row(r"(?:if|whenever)\b", "when", languages=_SYSTEM),
    _row(r"unless\b", "when not", languages=_SYSTEM),
    _row(r"(?:arg|args)\b", "argument", languages=_SYSTEM),
    _row(
        r"arguments\b\s*", "", "remove 'arguments': each begins with 'argument'", languages=_SYSTEM
    ),
    # System descriptions
    _row(
        r"remap\s+(?P<port>[\w/~]+)\s*(?::=|to|=|->)\s*(?P<to>[\w/~]+)",
        r"connect \g<port> to \g<to>",
        languages=_SYSTEM,
    ),
    _row(
        r"remap\s+(?P<port>[\w/~]+)\s+to\s+(?P<to>[\w/~]+)",
        r"wirings connect \g<port> to \g<to>",
        languages=_SYSTEM,
    ),
    _row(
        r"(?P<port>[\w/~]+)\s*(?:->|=>|:=)\s*(?P<to>[\w/~]+)",
        r"connect \g<port> to \g<to>",
        languages=_SYSTEM,
    ),
    _row(r"=(?=\s*[/~])", "to", languages=_SYSTEM),
    _row(r"name\s+(?=\w+\s*=)", "param ", languages=_SYSTEM),
    _row(
        r"(?P<name>[a-z_]\w*)\s*[:=]\s*(?P<value>[^\n]+)",
        r"param \g<name> = \g<value>",
        languages=_SYSTEM,
    ),
    _row(
        rf"=\s*{NUMBER}\s*(?P<at>)[A-Za-z]",
        None,
        "write the number in the unit of the parameter, without a unit",
        "values are written without a unit",
        _SYSTEM,
    ),
    _row(r"\(\)", "", "remove '()'", languages=_SYSTEM),
    _row(r"ns\b", "namespace", languages=_SYSTEM),
    _row(r"include\b", "import", languages=_SYSTEM),
    _row(
        r"(?<=parameters from )[\w./~$:{}-]+\.ya?ml\b",
        in_quotes,
        "write '{edit}'",
        "a path stands in quotes",
        _SYSTEM,
    ),
    _row(
        r"from\s+(?=\"[^\"\n]*\.ya?ml\")",
        "parameters from ",
        "write 'parameters from'",
        "a parameter file follows 'parameters from'",
        _SYSTEM,
    ),
    _row(r"from\b", None, "a file is imported as a whole: 'import \"FILE\"'", "", _SYSTEM),
    _row(
        r"import\s+(?P<at>)\w+\s+from\s+(?=\")",
        "import ",
        "a file is imported as a whole: 'import \"FILE\"'",
        languages=_SYSTEM,
    ),
    _row(r"-\s*(?=/)", "topic ", languages=_SYSTEM),
    _row(
        r"connect\s+(?P<kind>[a-z_]+)\s+to\s+to\s+(?P<at>)(?=[\"$~/\w])",
        r'connect \g<kind> "to" to ',
        "write '\"to\"'",
        "behind its kind, a port called 'to' stands in quotes",
        _SYSTEM,
    ),
)


def habits(text: str, position: int, start: int, language: Language) -> Iterator[Habit]:
    """Yield the habits that explain why a text does not parse at a position.

    Args:
        text: the whole text.
        position: where it does not parse.
        start: where its statement begins.
        language: of the text.
    """
    for row in _ROWS:
        if row.languages and language not in row.languages:
            continue
        # Most rows have no such group; a call for each of them would double the work.
        if row.pattern.groupindex:
            match = _match(row.pattern, text, position, start)
        else:
            match = row.pattern.match(text, position)
        if match is not None:
            edit = row.edit(match)
            yield Habit(
                match.start(),
                match.end(),
                edit,
                row.words(match).replace("{edit}", edit or ""),
                row.message,
                row.reads_as,
            )


def _match(pattern: re.Pattern[str], text: str, position: int, start: int) -> re.Match[str] | None:
    """Match a pattern whose group ``at``, or whose start, is at a position."""
    if "at" not in pattern.groupindex:
        return pattern.match(text, position)
    begin = max(start, position - _LOOK_AROUND)
    line_end = text.find("\n", position + _LOOK_AROUND, position + 2 * _LOOK_AROUND)
    end = position + 2 * _LOOK_AROUND if line_end < 0 else line_end
    found = (each for each in pattern.finditer(text, begin, end) if each.start("at") >= position)
    match = next(found, None)
    return match if match is not None and match.start("at") == position else None
