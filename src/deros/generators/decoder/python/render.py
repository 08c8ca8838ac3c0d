"""The text of a module that decodes messages."""

from __future__ import annotations

import builtins
from collections.abc import Sequence
from dataclasses import dataclass

from deros.generators.decoder.python.emitter import DecoderEmitter
from deros.generators.decoder.python.field_selection import look_up, select
from deros.generators.decoder.python.module import Parts, is_view
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
from deros.interfaces.fields import FieldPath, Key, ResolvedField, format_path, resolve
from deros.interfaces.store import InterfaceStore
from deros.interfaces.types import FLOAT_TYPES, STRING_TYPES, FieldType, InterfaceType

_RESERVED = frozenset(
    {"NAN", "at", "both", "byte_order", "data", "elements", "np", "order", "string", "struct"}
    | {"find", "wstring", *(name for name in dir(builtins) if name.islower())}
)


@dataclass(frozen=True, slots=True)
class Topic:
    """A topic and the fields of its messages that a decoder reads.

    Attributes:
        name: an identifier, unique among the topics.
        type: the message type.
        paths: the fields in the order in which the decoder returns them: primitives, arrays of
            primitives, and arrays of messages, of which only the length is read.
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
    """The lines of one decoder for the template."""

    groups: tuple[tuple[str, ...], ...]
    signature: tuple[str, ...]
    documentation: tuple[str, ...]
    lines: tuple[str, ...]


def render_decoders(topics: Sequence[Topic], store: InterfaceStore) -> str:
    """Return the text of a module with one function per topic, ``decode_<name>(data: bytes)``.

    A decoder takes a serialized message, as rclpy passes it to the callback of a raw subscription.
    It returns the values of the topic's paths as a tuple, or the value itself if there is only one.
    Numbers, booleans and strings are Python's own, ``byte`` is an integer, and NaN is the value of
    an element that an array does not have. Arrays of numbers are read-only NumPy views of the data
    if their length is not fixed or greater than 64. Others are tuples of numbers and booleans, or
    lists of strings. The value of an array of messages is a ``range`` of the same length.

    A decoder raises one of ``DECODING_ERRORS`` of the module if the data is not plain CDR, or too
    short for the selected fields. The module needs only the standard library, and NumPy if there
    are such views.

    Raises:
        ValueError: if a message type is unknown, or a path does not lead to a field.
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
    emitter = DecoderEmitter(store, writer, START)
    selection = select(paths, variables)
    look_up(selection, store, topic.type, names)
    emitter.message(topic.type, selection, more_selected=False)
    emitter.read_gathered()
    return _Decoder(
        tuple(tuple(group) for group in writer.groups),
        tuple(_signature(topic.function, types)),
        tuple(_documentation(topic, paths)),
        tuple(_with_return(writer.lines, [variables[path] for path in paths])),
    )


def _annotation(store: InterfaceStore, kind: InterfaceType, path: FieldPath) -> str:
    """Return the type of a value as Python source text."""
    found = resolve(store, kind, path)
    if not isinstance(found, ResolvedField) or not path:
        reason = "is the whole message" if isinstance(found, ResolvedField) else found.message
        raise ValueError(f"{kind.short}: '{format_path(path)}': {reason}")
    text = _value_type(found.type)
    may_lack = any(
        isinstance(part, Key)
        or (isinstance(part, int) and _array(store, kind, path[:position]) != "fixed")
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
    return "np.ndarray" if is_view(type_) else f"tuple[{scalar}, ...]"


def _signature(function: str, types: Sequence[str]) -> list[str]:
    """Return the head of a decoder, which returns one value as it is and several as a tuple."""
    head = f"def {function}(data: bytes) -> "
    if len(types) == 1:
        return [f"{head}{types[0]}:"]
    return lay_out_call(0, f"{head}tuple[", list(types) or ["()"], "]:")


def _documentation(topic: Topic, paths: Sequence[FieldPath]) -> list[str]:
    """Return the lines of the docstring, which is on one line if it fits."""
    fields = ", ".join(map(format_path, paths)).replace("\\", r"\\") or "nothing"
    lines = ['"""', f"Return fields of a {topic.type}.", "", f"In order: {fields}.", '"""']
    several = join(HARDLINE, map(paragraph, lines))
    one = f'"""Return {fields} of a {topic.type}."""'
    return render_lines(breakable(one, lambda _: several), LINE_LENGTH, 4)


def _with_return(lines: Sequence[str], variables: Sequence[str]) -> list[str]:
    """Return the body with its return statement, which replaces an assignment at the end."""
    if not variables:
        return ["    byte_order(data)", "    return ()"]
    lines = ["    order = byte_order(data)", *lines]
    result = ", ".join(variables)
    head = f"    {result} = "
    if lines[-1].startswith(head):
        return [*lines[:-1], f"    return {lines[-1].removeprefix(head)}"]
    if len(variables) == 1:
        return [*lines, f"    return {result}"]
    return [*lines, *_return(variables)]


def _return(variables: Sequence[str]) -> list[str]:
    document = filled(concat("return ", if_broken("(")), variables, if_broken(")"))
    return render_lines(document, LINE_LENGTH, 4)
