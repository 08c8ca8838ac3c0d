"""The text of a module that decodes messages."""

from __future__ import annotations

import builtins
from collections.abc import Sequence
from dataclasses import dataclass

from deros.generators.decoder.python.emitter import SMALL, DecoderEmitter
from deros.generators.decoder.python.field_selection import tree
from deros.generators.decoder.python.module import Parts
from deros.generators.decoder.python.position import START
from deros.generators.decoder.python.writer import Writer
from deros.generators.text.document import (
    HARDLINE,
    breakable,
    concat,
    if_broken,
    join,
    render_lines,
)
from deros.generators.text.prose import paragraph
from deros.generators.text.python import LINE_LENGTH, filled, lay_out_call, mark_long_lines
from deros.generators.text.templates import environment
from deros.generators.text.unique_names import UniqueNames
from deros.interfaces.fields import FieldPath, ResolvedField, format_path, resolve
from deros.interfaces.store import InterfaceStore
from deros.interfaces.types import FLOAT_TYPES, STRING_TYPES, FieldType, InterfaceType

_RESERVED = frozenset(
    {"NAN", "at", "both", "byte_order", "data", "elements", "np", "order", "string", "struct"}
    | {"wstring", *(name for name in dir(builtins) if name.islower())}
)


@dataclass(frozen=True, slots=True)
class Topic:
    """What is to be read of a topic's messages.

    Attributes:
        name: an identifier, different from those of the other topics.
        type: of its messages.
        paths: the wanted fields, in the order in which the decoder returns them: primitives and
            arrays, of messages where nothing but their number is of interest.
    """

    name: str
    type: InterfaceType
    paths: Sequence[FieldPath]

    @property
    def function(self) -> str:
        """The name of the decoder in the module."""
        return f"decode_{self.name}"


@dataclass(frozen=True, slots=True)
class _Decoder:
    """What the template prints of one decoder."""

    groups: tuple[tuple[str, ...], ...]
    signature: tuple[str, ...]
    documentation: tuple[str, ...]
    lines: tuple[str, ...]


def render_decoders(topics: Sequence[Topic], store: InterfaceStore) -> str:
    """Return the text of a module with one function per topic, ``decode_<name>(data: bytes)``.

    A decoder takes a serialized message, as rclpy hands it to the callback of a raw subscription,
    and returns the values of the topic's paths as a tuple, or the bare value if there is just one.
    Numbers, booleans and strings are Python's own, ``byte`` is an integer, and NaN stands for an
    element that an array does not have. Arrays of numbers are read-only NumPy views of the data if
    their length is not fixed, or greater than 64; others are tuples of numbers and booleans, or
    lists of strings. An array of messages comes out as a ``range`` as long as it.

    Data that is no plain CDR, or too short for what is wanted of it, raises one of the module's
    ``DECODING_ERRORS``. The module needs the standard library alone, and NumPy if such views occur.

    Raises:
        ValueError: if a message type is not known, or a path leads to no such field.
    """
    parts = Parts()
    constants = UniqueNames(frozenset({"NAN", "DECODING_ERRORS"}))
    decoders = [_decoder(topic, store, parts, constants) for topic in topics]
    template = environment("deros.generators.decoder.python").get_template("decoders.py.j2")
    text: str = template.render(
        decoders=decoders, shared=sorted(parts.shared.items()), helpers=parts.helpers
    )
    return mark_long_lines(text.rstrip("\n") + "\n")


def _decoder(topic: Topic, store: InterfaceStore, parts: Parts, constants: UniqueNames) -> _Decoder:
    paths = [tuple(path) for path in topic.paths]
    names = UniqueNames(_RESERVED)
    variables = {path: names.new(*path) for path in dict.fromkeys(paths)}
    writer = Writer(names, parts, topic.name.upper(), constants)
    types = [_annotation(store, topic.type, path) for path in paths]
    walk = DecoderEmitter(store, writer, START)
    walk.message(topic.type, tree(paths, variables), later=False)
    walk.read_gathered()
    result = f"tuple[{', '.join(types) or '()'}]" if len(paths) != 1 else types[0]
    return _Decoder(
        tuple(tuple(group) for group in writer.groups),
        tuple(_signature(topic.function, result)),
        tuple(_documentation(topic, paths)),
        tuple(_with_return(writer.lines, [variables[path] for path in paths])),
    )


def _annotation(store: InterfaceStore, kind: InterfaceType, path: FieldPath) -> str:
    """Return the type of a value, as Python writes it."""
    found = resolve(store, kind, path)
    if not isinstance(found, ResolvedField) or not path:
        reason = "is the whole message" if isinstance(found, ResolvedField) else found.message
        raise ValueError(f"{kind.short}: '{format_path(path)}': {reason}")
    text = _value_type(found.type)
    may_lack = any(
        isinstance(part, int) and _array(store, kind, path[:position]) != "fixed"
        for position, part in enumerate(path)
    )
    if not may_lack or text == "float":
        return text
    return "float" if text == "int" else f"{text} | float"


def _array(store: InterfaceStore, kind: InterfaceType, path: FieldPath) -> str | None:
    found = resolve(store, kind, path)
    assert isinstance(found, ResolvedField)
    return found.type.array


def _value_type(type_: FieldType) -> str:
    if isinstance(type_.base, InterfaceType):
        if not type_.is_array:
            raise ValueError(f"{type_.base.short} is a message, not a value")
        return "range"
    if type_.base in STRING_TYPES:
        return "list[str]" if type_.is_array else "str"
    scalar = "float" if type_.base in FLOAT_TYPES else "bool" if type_.base == "bool" else "int"
    if not type_.is_array:
        return scalar
    is_tuple = scalar == "bool" or (type_.array == "fixed" and (type_.size or 0) <= SMALL)
    return f"tuple[{scalar}, ...]" if is_tuple else "np.ndarray"


def _signature(function: str, result: str) -> list[str]:
    head = f"def {function}(data: bytes) -> "
    if not result.startswith("tuple["):
        return [f"{head}{result}:"]
    types = result.removeprefix("tuple[").removesuffix("]").split(", ")
    return lay_out_call(0, f"{head}tuple[", types, "]:")


def _documentation(topic: Topic, paths: Sequence[FieldPath]) -> list[str]:
    """Return the docstring: in one line if it fits."""
    fields = ", ".join(map(format_path, paths)) or "nothing"
    lines = ['"""', f"Return fields of a {topic.type}.", "", f"In order: {fields}.", '"""']
    several = join(HARDLINE, map(paragraph, lines))
    one = f'"""Return {fields} of a {topic.type}."""'
    return render_lines(breakable(one, lambda _: several), LINE_LENGTH, 4)


def _with_return(lines: Sequence[str], variables: Sequence[str]) -> list[str]:
    """Return the body with its last statement, which may be what has been written last."""
    if not variables:
        return ["    byte_order(data)", "    return ()"]
    lines = ["    order = byte_order(data)", *lines]
    result = ", ".join(variables)
    head = f"    {result} = "
    if lines[-1].startswith(head):
        return [*lines[:-1], f"    return {lines[-1].removeprefix(head)}"]
    return [*lines, *_return(variables)]


def _return(variables: Sequence[str]) -> list[str]:
    document = filled(concat("return ", if_broken("(")), variables, if_broken(")"))
    return render_lines(document, LINE_LENGTH, 4)
