"""Syntax errors in the user's words: what was found where, and what could stand there instead."""

from __future__ import annotations

import re
import unicodedata
from typing import Any

from arpeggio import EndOfFile, NoMatch
from textx.exceptions import TextXSyntaxError

from deros import codes
from deros.diagnostics import Diagnostic, SourceFile, Span, report
from deros.interfaces.names import did_you_mean, near

_WORDS = {
    "Name": "a name",
    "RosParameterName": "a parameter's name",
    "PortKindName": "a kind of port such as publisher",
    "PortName": "a port",
    "BoundOperator": "a bound such as >= 0",
    "TermName": "a name",
    "GraphName": "a topic name",
    "MarkedGraphName": "a topic name",
    "InterfaceName": "a type such as std_msgs.Bool",
    "ParameterTypeName": "a parameter type such as double",
    "Text": 'a text in "quotes"',
    "LiteralText": "true, false or a text",
    "Scalar": "a value",
    "Number": "a number",
    "Integer": "a whole number",
    "UnitText": "a unit",
    "LossUnit": "a unit",
    "LossName": "'heartbeat' or 'input'",
    "BracketUnit": "a unit",
    "FieldPath": "a field",
    "Path": "a field",
    "FieldSeparator": "','",
    "Operator": "a comparison",
    "IntervalOpening": "'[' or '('",
    "IntervalClosing": "']' or ')'",
    "TopicKeyword": "'topic'",
    "TopicsKeyword": "'publishes' or 'subscribes'",
    "ActionsKeyword": "'actions' or 'action_clients'",
    "QosTimeName": "'deadline' or 'lifespan'",
    "QosWordName": "a QoS policy such as reliable",
    "QosLivelinessKind": "'automatic' or 'manual_by_topic'",
    "LogLevelName": "debug, info, warn, error or fatal",
}
_FOUND = re.compile(r'"[^"\\\n]*(?:\\.[^"\\\n]*)*"|[\w/~]+|.', re.DOTALL)
_MOST_NAMED = 4


def explain(error: TextXSyntaxError, source: SourceFile) -> Diagnostic:
    """Turn textX's syntax error into a diagnostic at the same place."""
    cause = error.__cause__
    position = cause.position if isinstance(cause, NoMatch) else len(source.text)
    expected = list(dict.fromkeys(in_words(rule) for rule in error.expected_rules or ()))
    if len(expected) > 1 and "';'" in expected:
        expected.remove("';'")
    found = _FOUND.match(source.text, position)
    if found is None:
        end = len(source.text.rstrip())
        return _at_the_end(Span(source, end, end), expected)
    span = Span(source, found.start(), found.end())
    text = found.group()
    if text == '"':
        message = "this text is not closed"
        return report(codes.SYNTAX_ERROR, message, span, "close it with '\"' on the same line")
    words = [word[1:-1] for word in expected if word.startswith("'")]
    hint = did_you_mean(near(text, words)) if text[0].isalpha() else ""
    return report(codes.SYNTAX_ERROR, f"{_described(text)} {_missing(expected)}", span, hint)


def _at_the_end(span: Span, expected: list[str]) -> Diagnostic:
    if not span.source.text.strip():
        return report(codes.SYNTAX_ERROR, "the file holds no model: it is empty", span)
    return report(codes.SYNTAX_ERROR, f"the file ends {_missing(expected)}", span)


def _missing(expected: list[str]) -> str:
    if not expected:
        return "where it makes no sense"
    if len(expected) > _MOST_NAMED:
        # Past a few, the first ones tell what kind of thing is wanted.
        return f"where something else is expected: {', '.join(expected[:_MOST_NAMED])}, …"
    *others, last = expected
    return (
        f"where {', '.join(others)} or {last} is expected"
        if others
        else f"where {last} is expected"
    )


def _described(text: str) -> str:
    if len(text) > 1:
        text = "".join(each if each.isprintable() else f"\\u{ord(each):04x}" for each in text)
    if text.isprintable() and not text.isspace():
        return f"found {text if text.startswith(chr(34)) else repr(text)}"
    name = unicodedata.name(text, "control character").lower()
    return f"found the character U+{ord(text):04X} ({name})"


def in_words(rule: Any) -> str:
    """Name what a token of the grammar matches, as a user would."""
    if isinstance(rule, EndOfFile):
        return "the end of the file"
    words = _WORDS.get(rule.rule_name)
    return words if words is not None else f"'{getattr(rule, 'to_match', rule.rule_name)}'"
