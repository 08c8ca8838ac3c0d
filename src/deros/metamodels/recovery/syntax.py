"""Messages for syntax errors: the token found, and the tokens expected instead."""

from __future__ import annotations

import re
import unicodedata
from collections.abc import Iterable
from typing import Any

from arpeggio import EndOfFile

from deros import codes
from deros.diagnostics import Diagnostic, Fix, SourceFile, Span, report
from deros.metamodels.grammar import words_of
from deros.names.names import did_you_mean, near

_WORDS = {
    "Name": "a name",
    "RosParameterName": "a parameter's name",
    "PortKindName": "a kind of port such as publisher",
    "PortName": "a port",
    "BoundOperator": "a bound such as >= 0",
    "TermName": "a name",
    "EntriesWord": "a name",
    "HeededAction": "a name",
    "GraphName": "a topic name",
    "FrameName": "the name of a frame",
    "MarkedGraphName": "a topic name",
    "InterfaceName": "a type such as std_msgs.Bool",
    "ParameterTypeName": "a parameter type such as double",
    "Text": 'a string in "quotes"',
    "LiteralText": "true, false or a string",
    "Scalar": "a value",
    "LoneScalar": "a value",
    "ArrayItem": "a value",
    "ArgumentUse": "an argument such as $speed",
    "LookupName": "a value",
    "ArgumentInCondition": "an argument",
    "ComputedName": "a topic name",
    "ProgramPath": "a name, as Upload/pack",
    "FilePath": 'a path in "quotes"',
    "SumOperator": "an operator",
    "ProductOperator": "an operator",
    "ComparisonOperator": "a comparison",
    "Number": "a number",
    "UnsignedNumber": "a number",
    "Integer": "a whole number",
    "UnitText": "a unit",
    "LossUnit": "a unit",
    "LossName": "'heartbeat' or 'input'",
    "TargetName": "'python' or 'cpp'",
    "BracketUnit": "a unit",
    "UnitOpening": "'['",
    "FieldPath": "a field",
    "Path": "a field",
    "FieldSeparator": "','",
    "ArithmeticOperator": "an operator",
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
    "FailurePolicyName": "'stop' or 'continue'",
    "AwaitedProgramName": "'node' or 'active'",
    "AwaitedEndName": "'service' or 'topic'",
    "ContainerThreadsName": "'multi_threaded' or 'isolated'",
}
_FOUND = re.compile(r'"[^"\\\n]*(?:\\.[^"\\\n]*)*"|[\w/~]+|.', re.DOTALL)
_MOST_NAMED = 4


def found_at(text: str, position: int) -> str:
    """Return the token at a position of a text, as a person would read it; "" at the end."""
    found = _FOUND.match(text, position)
    return found.group() if found is not None else ""


def explain(
    source: SourceFile, position: int, rules: Iterable[Any], hint: str = "", fix: Fix | None = None
) -> Diagnostic:
    """Return the diagnostic of a position where only a match of ``rules`` is valid.

    Args:
        source: the file.
        position: of the first character that does not parse.
        rules: the tokens of the grammar that are valid there.
        hint: what to do, if that is known; else the keywords that nearly match are offered.
        fix: the hint as an edit.
    """
    expected = list(dict.fromkeys(in_words(rule) for rule in rules))
    if len(expected) > 1 and "';'" in expected:
        expected.remove("';'")
    text = found_at(source.text, position)
    if not text:
        end = len(source.text.rstrip())
        return _at_the_end(Span(source, end, end), expected, hint, fix)
    span = Span(source, position, position + len(text))
    if text == '"':
        message = "this string is not closed"
        return report(codes.SYNTAX_ERROR, message, span, "close it with '\"' on the same line")
    words = [word[1:-1] for word in expected if word.startswith("'")]
    if not hint and text[0].isalpha():
        hint = did_you_mean(near(text, words))
    message = f"{_described(text)} {_missing(expected)}"
    return report(codes.SYNTAX_ERROR, message, span, hint, fix=fix)


def _at_the_end(span: Span, expected: list[str], hint: str, fix: Fix | None) -> Diagnostic:
    if not span.source.text.strip():
        return report(codes.SYNTAX_ERROR, "the file is empty: it contains no model", span)
    message = f"the file ends {_missing(expected)}"
    return report(codes.SYNTAX_ERROR, message, span, hint, fix=fix)


def _missing(expected: list[str]) -> str:
    if not expected:
        return "where it is not expected"
    if len(expected) > _MOST_NAMED:
        # Of many, the first ones show which kind of token is expected.
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
    """Return a user's name for the text that a token of the grammar matches."""
    if isinstance(rule, EndOfFile):
        return "the end of the file"
    words = _WORDS.get(rule.rule_name)
    if words is not None:
        return words
    literals = words_of(rule)
    return f"'{literals[0] if len(literals) == 1 else rule.to_match}'"
