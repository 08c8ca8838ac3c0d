"""The type of a scalar in a parameter file, as ROS 2 tells it.

Source: ``get_value`` in ``rcl_yaml_param_parser/src/parse.c`` (Jazzy). It is neither YAML 1.1 nor
1.2: ``on`` is true, ``010`` is 8, ``~`` and ``null`` are texts, and so is ``1e999``.
"""

from __future__ import annotations

import math
import re
import sys

import yaml

from deros.interfaces.types import INT64
from deros.models.common import Scalar

_TRUE = frozenset(["Y", "y", "yes", "Yes", "YES", "true", "True", "TRUE", "on", "On", "ON"])
_FALSE = frozenset(["N", "n", "no", "No", "NO", "false", "False", "FALSE", "off", "Off", "OFF"])
_INTEGER = re.compile(r"[+-]?(?:0[xX][0-9a-fA-F]+|0[0-7]*|[1-9][0-9]*)", re.ASCII)
_DECIMAL = re.compile(r"[+-]?(?:[0-9]+\.?[0-9]*|\.[0-9]+)(?:[eE][+-]?[0-9]+)?", re.ASCII)
_HEXADECIMAL = re.compile(
    r"[+-]?0[xX](?:[0-9a-fA-F]+\.?[0-9a-fA-F]*|\.[0-9a-fA-F]+)(?:[pP][+-]?[0-9]+)?", re.ASCII
)
_SPECIAL = re.compile(r"[+-]?(?:inf|infinity|nan(?:\([0-9A-Za-z_]*\))?)", re.IGNORECASE)
_YAML_SPECIAL = re.compile(r"[+-]?\.(?:inf|Inf|INF)|\.(?:nan|NaN|NAN)")
_SPACE = " \t\n\v\f\r"


def value_of(text: str, *, is_text: bool) -> Scalar:
    """Return the value of a scalar; ``is_text``: it is quoted, or tagged as a text."""
    if is_text:
        return text
    if text in _TRUE or text in _FALSE:
        return text in _TRUE
    # A text in a block (``|``) may start with blanks, which C's own functions skip.
    number = _number(text.lstrip(_SPACE))
    return text if number is None else number


def is_misread(text: str) -> bool:
    """Return whether ROS 2 reads a text as a bool or a number that PyYAML has written."""
    is_quoted = yaml.safe_dump(text)[:1] in ("'", '"')
    return not is_quoted and not isinstance(value_of(text, is_text=False), str)


def _number(text: str) -> int | float | None:
    if _INTEGER.fullmatch(text) and len(text) < 100:
        value = _integer(text)
        if value in INT64:
            return value
    if _YAML_SPECIAL.fullmatch(text):
        number = float(text.replace(".", ""))
    elif _SPECIAL.fullmatch(text):
        return float(text.partition("(")[0])
    elif _DECIMAL.fullmatch(text):
        number = float(text)
        if _is_out_of_range(number, text.lower().partition("e")[0]):
            return None
    elif _HEXADECIMAL.fullmatch(text):
        try:
            number = float.fromhex(text)
        except OverflowError:
            return None
        if _is_out_of_range(number, text.lower().partition("x")[2].partition("p")[0]):
            return None
    else:
        return None
    return number


def _integer(text: str) -> int:
    digits = text.lstrip("+-")
    sign = -1 if text.startswith("-") else 1
    if digits[:2].lower() == "0x":
        return sign * int(digits, 16)
    return sign * int(digits, 8 if digits.startswith("0") and len(digits) > 1 else 10)


def _is_out_of_range(number: float, mantissa: str) -> bool:
    """Return whether C reports ``ERANGE``: then the scalar stays a text."""
    if math.isinf(number):
        return True
    is_zero = not re.search("[1-9a-f]", mantissa)
    return abs(number) < sys.float_info.min and not is_zero
