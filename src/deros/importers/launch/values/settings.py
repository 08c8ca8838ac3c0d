"""The values of parameters in a launch file, as launch and launch_ros read them."""

from __future__ import annotations

from collections.abc import Iterator
from typing import NamedTuple

from deros.importers.launch.entities import Entity
from deros.importers.launch.values.conditions import literally
from deros.importers.launch.values.expressions import Expressions, Marked
from deros.importers.launch.values.substitutions import InexpressibleError, pieces_of
from deros.importers.launch.values.writing import Writer
from deros.importers.launch.values.xacro import XacroCall, xacro_call
from deros.interfaces.types import INT64
from deros.metamodels.launch_files.yaml_values import yaml_value
from deros.models.arguments import Chosen, Expression, Interpolation, Literally
from deros.models.node import NodeType, ParameterType
from deros.names.names import check_parameter_name, not_text

_KINDS = {"bool": "bool", "int": "int", "float": "double", "str": "string"}
_DECLARED = {
    ParameterType.BOOL: "bool",
    ParameterType.INTEGER: "int",
    ParameterType.DOUBLE: "double",
    ParameterType.STRING: "string",
}


class Setting(NamedTuple):
    """A parameter and its value: one, or those of a list."""

    name: str
    value: Expression | tuple[Expression, ...] | XacroCall
    kind: str | None

    def write(self, writer: Writer) -> str:
        """Return the value, with what stands before it."""
        if isinstance(self.value, XacroCall):
            return self.value.write(writer)
        return f"= {self._value(self.value, writer)}"

    def _value(self, value: Expression | tuple[Expression, ...], writer: Writer) -> str:
        if isinstance(value, tuple):
            return f"[{', '.join(self._item(each, writer) for each in value)}]"
        kind = writer.type_of(value)
        if self.kind is not None and kind == "string" != self.kind and not writer.is_draft:
            raise InexpressibleError(f"is a {self.kind}, and its argument is used as a text, too")
        return writer.expression(value, self.kind)

    def _item(self, found: Expression, writer: Writer) -> str:
        if isinstance(found, Literally):
            return writer.expression(found)
        kind = writer.type_of(found)
        if kind is not None:
            return writer.expression(found, self.kind)
        if self.kind not in (None, "string"):
            return f"${writer.computed(found, self.kind)}"
        return writer.text(found)


def settings(
    found: Entity, expressions: Expressions, model: NodeType | None, prefix: str = ""
) -> Iterator[Setting]:
    """Yield what an element ``param`` sets, with those in it.

    Raises:
        InexpressibleError: a model cannot say it.
    """
    name = expressions.of(found.needed("name"))
    if not isinstance(name, Literally):
        raise InexpressibleError("has a computed name")
    full = f"{prefix}{name.value}"
    inner = found.details("param")
    if inner:
        for each in inner:
            yield from settings(each, expressions, model, f"{full}.")
        return
    if why := check_parameter_name(full):
        raise InexpressibleError(f"has the name '{full}', which {why}")
    yield Setting(full, *_value(found, expressions, _declared(model, full)))


def _declared(model: NodeType | None, name: str) -> str | None:
    declared = None if model is None else model.parameter_for(name)
    return None if declared is None else _DECLARED.get(declared.type)


def _value(
    found: Entity, expressions: Expressions, declared: str | None
) -> tuple[Expression | tuple[Expression, ...] | XacroCall, str | None]:
    word = found.get("type") or ""
    kind = _KINDS.get(word.removeprefix("list_of_")) if word else None
    if word and kind is None:
        raise InexpressibleError(f"has the type '{word}', which launch does not have")
    items = found.details("value")
    separator = found.get("value-sep")
    if items:
        texts = [each.element.text for each in items]
        return _list([_scalar(expressions.marked(pieces_of(e)), kind) for e in texts], kind)
    value = found.needed("value")
    call = xacro_call(value, expressions)
    if call is not None:
        return call, "string"
    listed = None if word == "str" else _read(value)
    if isinstance(listed, list):  # launch takes a list apart before it looks at its items
        if word and not word.startswith("list_of_"):
            raise InexpressibleError("has a list, and is of a type that is none")
        return _list([_listed(each, expressions, kind) for each in listed], kind)
    if separator:
        texts = value.split(separator)
        return _list([_scalar(expressions.marked(pieces_of(e)), kind) for e in texts], kind)
    return value_of(expressions.marked(pieces_of(value)), kind, "list" in word, declared)


def value_of(
    marked: Marked, kind: str | None, is_list: bool, declared: str | None = None
) -> tuple[Expression | tuple[Expression, ...], str | None]:
    """Return the value that a text is, and its type if that is known.

    Raises:
        InexpressibleError: a model cannot say it.
    """
    read = None if kind == "string" and not is_list else _read(marked.text)
    if isinstance(read, list):
        if kind is not None and not is_list:
            raise InexpressibleError("has a list, and is of a type that is none")
        return _list([_item(each, marked, kind) for each in read], kind)
    if is_list:
        raise InexpressibleError("has no list, and is of a type that is one")
    scalar = _scalar(marked, kind)
    is_open = not isinstance(scalar, Literally | Interpolation)
    return scalar, kind or (declared if is_open else None)


def _list(items: list[Expression], kind: str | None) -> tuple[tuple[Expression, ...], str | None]:
    if not items:
        raise InexpressibleError("is an empty list, which has no type")
    kinds = {type(each.value) for each in items if isinstance(each, Literally)}
    if kinds == {int, float}:
        items = [literally(float(e.value)) if isinstance(e, Literally) else e for e in items]
    elif len(kinds) > 1:
        raise InexpressibleError("is a list of values of several types")
    if kind is None and kinds:
        names = {bool: "bool", int: "int", float: "double", str: "string"}
        kind = "double" if kinds == {int, float} else names[kinds.pop()]
    return tuple(items), kind


def _listed(value: object, expressions: Expressions, kind: str | None) -> Expression:
    if not isinstance(value, str):
        return _item(value, expressions.marked(()), kind)
    marked = expressions.marked(pieces_of(value))
    return _scalar(marked, kind or (None if marked.values else "string"))


def _item(value: object, marked: Marked, kind: str | None) -> Expression:
    if isinstance(value, str):
        return _converted(marked.expression(value), kind or "string")
    if isinstance(value, bool | int | float):
        text = "true" if value is True else "false" if value is False else repr(value)
        return _converted(literally(text), kind)
    raise InexpressibleError("has a list of what no parameter can be")


def _scalar(marked: Marked, kind: str | None) -> Expression:
    if kind is None:
        read = _read(marked.text)
        if isinstance(read, str):
            return _converted(marked.expression(read), None if marked.is_one(read) else "string")
        if isinstance(read, dict):
            raise InexpressibleError("is a mapping")
    return _converted(marked.expression(marked.text), kind)


def _converted(found: Expression, kind: str | None) -> Expression:
    """Return a value with the texts in it as values of a type, or of what they look like."""
    if isinstance(found, Literally):
        return _literal(str(found.value), kind)
    if isinstance(found, Chosen):
        chosen, otherwise = _converted(found.chosen, kind), _converted(found.otherwise, kind)
        return Chosen(found.condition, chosen, otherwise, found.span)
    if isinstance(found, Interpolation):
        if kind not in (None, "string"):
            raise InexpressibleError(f"is put together, and is no text but a {kind}")
        for each in found.pieces:
            _checked(each) if isinstance(each, str) else None
    return found


def _literal(text: str, kind: str | None) -> Literally:
    if kind == "string":
        return literally(_checked(text))
    read = _read(text)
    if isinstance(read, bool) and kind in (None, "bool"):
        return literally(read)
    if isinstance(read, int) and not isinstance(read, bool):
        if kind == "double":
            return literally(float(read))
        if read not in INT64:
            raise InexpressibleError("is an integer of more than 64 bits")
        if kind in (None, "int"):
            return literally(read)
    if isinstance(read, float) and kind in (None, "double"):
        return literally(read)
    if kind == "double":
        return literally(_float(text))
    if kind is not None:
        raise InexpressibleError(f"is '{text}', which is not a value of its type")
    return literally(_checked(read if isinstance(read, str) else text))


def _float(text: str) -> float:
    try:
        return float(text)
    except ValueError as error:
        raise InexpressibleError(f"is '{text}', which is not a number") from error


def _checked(text: str) -> str:
    if not_text(text):
        raise InexpressibleError("has a character that no text may have")
    return text


def _read(text: str) -> object:
    """Return what YAML makes of a text; the text itself if that is nothing."""
    try:
        return yaml_value(text)
    except ValueError as error:
        raise InexpressibleError("is too long") from error
