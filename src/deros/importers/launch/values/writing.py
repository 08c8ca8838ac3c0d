"""Expressions and conditions as the system language writes them.

What it has no words for in one place, such as a choice within a text, becomes an argument of its
own, whose default is computed.
"""

from __future__ import annotations

import re
from collections.abc import Mapping

from deros.generators.node.description import quoted_text, value_text
from deros.importers.launch.values.argument_types import Declared, Use, converted
from deros.importers.launch.values.substitutions import InexpressibleError
from deros.models.arguments import (
    Argument,
    Calculation,
    Chosen,
    Compared,
    Condition,
    Expression,
    Holds,
    Interpolation,
    Joined,
    Literally,
    Lookup,
    Not,
    OneOf,
    Opposite,
    merged,
)

_PLAIN_DEFAULT = re.compile(r"[\w./:-]*")
_WORDS = frozenset({"true", "false"})
_TRUE = ("true", "True", "TRUE", "1")
_LARGEST = 20_000
"""Characters of one expression."""

VALUE_USES = {
    None: Use.VALUE,
    "bool": Use.BOOL,
    "int": Use.INTEGER,
    "double": Use.DOUBLE,
    "string": Use.STRING,
}
"""How a parameter of a type uses an argument that is its value."""


class Writer:
    """Writes expressions, and notes what they use arguments as."""

    def __init__(
        self, declared: Mapping[str, Declared], types: Mapping[str, str], is_draft: bool
    ) -> None:
        """Write for arguments of some types; in a draft, which only shows uses, they are texts."""
        self.is_draft = is_draft
        self._declared = declared
        self._types = dict(types)
        self._computed: dict[str, str] = {}
        self.lines: list[str] = []
        """The declarations of arguments so far."""

    def declare(self, found: Declared) -> None:
        """Write the declaration of an argument."""
        kind = self._types.get(found.name, "string")
        line = f"argument {found.name} : {kind}"
        if found.default is not None:
            line += f" = {self._default(found.default, kind)}"
        if found.choices and kind != "bool":
            line += f" one_of {value_text(tuple(converted(e, kind) for e in found.choices))}"
        said = f" {quoted_text(found.description)}" if found.description else ""
        self.lines.append(line + said)

    def _default(self, found: Expression, kind: str) -> str:
        if isinstance(found, Literally):
            return value_text(converted(str(found.value), kind))
        if isinstance(found, Chosen):
            chosen = self._default(found.chosen, kind)
            return f"if {self.when(found.condition)} then {chosen} else " + self._default(
                found.otherwise, kind
            )
        if isinstance(found, Argument):
            return f"${found.name}"
        return self.expression(found)

    def text(self, found: Expression) -> str:
        """Return a text where only texts may stand: an argument, or a text with values in it."""
        if isinstance(found, Argument):
            self._use(found, Use.TEXT)
            return f"${found.name}"
        pieces = merged((found,)) if isinstance(found, Interpolation) else (found,)
        written = "".join(map(self._piece, pieces))
        if len(written) > _LARGEST:
            raise InexpressibleError("is too long")
        return f'"{written}"'

    def _piece(self, piece: str | Expression) -> str:
        if isinstance(piece, Literally):
            piece = str(piece.value)
        if isinstance(piece, str):
            return quoted_text(piece, always=True)[1:-1].replace("${", "$${")
        if isinstance(piece, Argument):
            self._use(piece, Use.TEXT)
            return f"${{{piece.name}}}"
        if isinstance(piece, Lookup) and piece.name_from is None:
            if piece.function == "this_dir":
                return "${this_dir}"
            if piece.function == "share":
                return f"${{share({piece.name})}}"
            if piece.default is None:
                return f"${{env({piece.name})}}"
            if _PLAIN_DEFAULT.fullmatch(piece.default) and piece.default:
                return f"${{env({piece.name}, {piece.default})}}"
        return f"${{{self.computed(piece)}}}"

    def computed(self, found: Expression, kind: str = "string") -> str:
        """Return the name of an argument that is computed."""
        value = self._default(found, kind)
        key = f"{kind} {value}"
        if key not in self._computed:
            number = len(self._computed) + 1
            while (name := f"computed_{number}") in self._declared:
                number += len(self._declared)
            self._computed[key] = name
            self._types[name] = kind
            self.lines.append(f"argument {name} : {kind} = {value}")
        return self._computed[key]

    def passed(self, found: Expression) -> str:
        """Return the value of an argument of a launch file, which takes it as a text."""
        return f"${found.name}" if isinstance(found, Argument) else self.expression(found)

    def expression(self, found: Expression, kind: str | None = None) -> str:
        """Return the value of a parameter, or of an argument that is passed on."""
        if isinstance(found, Literally):
            return value_text(found.value).replace("${", "$${")
        if isinstance(found, Argument):
            self._use(found, VALUE_USES[kind])
            return f"${found.name}"
        if isinstance(found, Lookup):
            return self._lookup(found)
        if isinstance(found, Interpolation):
            return self.text(found)
        if isinstance(found, Chosen):
            chosen = self.expression(found.chosen, kind)
            otherwise = self.expression(found.otherwise, kind)
            return f"if {self.when(found.condition)} then {chosen} else {otherwise}"
        if isinstance(found, Opposite):
            return f"-{self._operand(found.operand)}"
        assert isinstance(found, Calculation)
        operands = self._operand(found.left), self._operand(found.right)
        return f"{operands[0]} {found.operator} {operands[1]}"

    def _operand(self, found: Expression) -> str:
        if isinstance(found, Argument):
            self._use(found, Use.NUMBER)
            return f"${found.name}"
        if isinstance(found, Chosen):
            parts = self._operand(found.chosen), self._operand(found.otherwise)
            return f"(if {self.when(found.condition)} then {parts[0]} else {parts[1]})"
        if isinstance(found, Literally):
            number = found.value
            if isinstance(number, str):
                number = converted(converted_number(number), "double")
            return value_text(number)
        if isinstance(found, Calculation | Opposite):
            return f"({self.expression(found)})"
        raise InexpressibleError("calculates with a text")

    def _lookup(self, found: Lookup) -> str:
        if found.function == "this_dir":
            return "this_dir"
        if found.function == "share":
            name = found.name_from
            quoted = quoted_text(found.name, always=True)
            inside = quoted if name is None else f'"{"".join(map(self._piece, merged((name,))))}"'
            return f"share({inside})"
        default = "" if found.default is None else f", {quoted_text(found.default, always=True)}"
        return f"env({quoted_text(found.name, always=True)}{default})"

    # Conditions ---------------------------------------------------------------------------------

    def when(self, found: Condition) -> str:
        """Return a condition."""
        written = self._condition(found, "")
        if len(written) > _LARGEST:
            raise InexpressibleError("is too long")
        return written

    def _condition(self, found: Condition, around: str) -> str:
        if isinstance(found, Joined):
            written = f" {found.word} ".join(self._condition(e, found.word) for e in found.operands)
            return f"({written})" if around and around != found.word else written
        if isinstance(found, Not):
            return f"not {self._condition(found.operand, 'not')}"
        if isinstance(found, Holds):
            return self._holds(found.operand)
        if isinstance(found, OneOf):
            return self._one_of(found, around)
        return self._compared(found)

    def _holds(self, value: Expression) -> str:
        name = self._compared_name(value)
        self._use_name(name, Use.TRUTH)
        if self._types.get(name, "string") == "bool":
            return name
        return f"{name} in {value_text(_TRUE)}"

    def _one_of(self, found: OneOf, around: str) -> str:
        name = self._compared_name(found.operand)
        if all(isinstance(e.value, str) for e in found.choices):
            self._use_name(name, Use.WORD, *(str(e.value) for e in found.choices))
        else:
            self._use_name(name, Use.NUMBER)
        kind = self._types.get(name, "string")
        if kind == "bool":
            operands = tuple(Compared("=", found.operand, e, found.span) for e in found.choices)
            return self._condition(Joined("or", operands, found.span), around or "and")
        return f"{name} in {value_text(tuple(_as_type(e, kind) for e in found.choices))}"

    def _compared(self, found: Compared) -> str:
        left, right = found.left, found.right
        if isinstance(left, Literally):
            left, right = right, left
            operator = found.operator.translate(str.maketrans("<>", "><"))
        else:
            operator = found.operator
        name = self._compared_name(left)
        if not isinstance(right, Literally):
            other = self._compared_name(right)
            use = Use.WORD if operator in ("=", "!=") else Use.NUMBER
            self._use_name(name, use)
            self._use_name(other, use)
            if name in self._declared:
                self._declared[name].peers.add(other)
            return f"{name} {operator} {other}"
        value = right.value
        if isinstance(value, bool) or (isinstance(value, str) and value.lower() in _WORDS):
            self._use_name(name, Use.TRUTH)
            if self._types.get(name, "string") == "bool":
                is_so = (str(value).lower() == "true") == (operator == "=")
                return name if is_so else f"not {name}"
        elif isinstance(value, str):
            self._use_name(name, Use.WORD, value)
        else:
            self._use_name(name, Use.NUMBER)
        kind = self._types.get(name, "string")
        is_order = operator not in ("=", "!=")
        if kind == "string" and not isinstance(value, str) and is_order and not self.is_draft:
            raise InexpressibleError("compares a text with a number")
        return f"{name} {operator} {value_text(_as_type(right, kind))}"

    def _compared_name(self, found: Expression) -> str:
        if isinstance(found, Argument):
            return found.name
        number = isinstance(found, Calculation | Opposite)
        return self.computed(found, "double" if number else "string")

    def _use(self, found: Argument, use: Use) -> None:
        self._use_name(found.name, use)

    def _use_name(self, name: str, use: Use, *words: str) -> None:
        if name in self._declared:
            self._declared[name].uses.add(use)
            self._declared[name].words.update(words)

    def type_of(self, found: Expression) -> str | None:
        """Return the type of an argument, ``None`` of all else."""
        return self._types.get(found.name, "string") if isinstance(found, Argument) else None


def converted_number(text: str) -> str:
    """Return a text that is a number.

    Raises:
        InexpressibleError: it is none.
    """
    if isinstance(converted(text, "double"), str):
        raise InexpressibleError(f"calculates with '{text}', which is not a number")
    return text


def _as_type(found: Literally, kind: str) -> bool | int | float | str:
    if kind == "string":
        return found.value if isinstance(found.value, str) else str(found.value)
    return converted(found.value, kind) if isinstance(found.value, str) else found.value
