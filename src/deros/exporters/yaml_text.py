"""Keys, lists and values as YAML, which every reader of YAML takes for the same."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping, Sequence

from deros.generators.text.yaml import is_plain_key, is_plain_text

Plain = bool | int | float | str | None
Data = Plain | Sequence["Data"] | Mapping[str, "Data"]


def yaml_text(data: Mapping[str, Data]) -> str:
    """Return the text of a document."""
    return "\n".join(_mapping(data, "")) + "\n"


def _mapping(data: Mapping[str, Data], margin: str) -> Iterator[str]:
    for key, value in data.items():
        name = f"{margin}{key if is_plain_key(key.removesuffix('<>')) else _quoted(key)}:"
        if _is_short(value):
            yield f"{name} {_short(value)}"
        elif isinstance(value, Mapping):
            yield name
            yield from _mapping(value, f"{margin}  ")
        else:
            assert isinstance(value, Sequence)
            assert not isinstance(value, str)
            yield name
            yield from _items(value, f"{margin}  ")


def _items(data: Sequence[Data], margin: str) -> Iterator[str]:
    for each in data:
        assert isinstance(each, Mapping)
        first, *rest = _mapping(each, f"{margin}  ")
        yield f"{margin}- {first.removeprefix(f'{margin}  ')}"
        yield from rest


def _is_short(data: Data) -> bool:
    """Return whether data stands in one line: values, lists of them, and what is empty."""
    if isinstance(data, Mapping):
        return not data
    if isinstance(data, Sequence) and not isinstance(data, str):
        return not any(isinstance(each, Mapping) for each in data)
    return True


def _short(data: Data) -> str:
    if isinstance(data, Mapping):
        return "{}"
    if isinstance(data, Sequence) and not isinstance(data, str):
        return f"[{', '.join(map(_short, data))}]"
    return _scalar(data)


def _scalar(value: Plain) -> str:
    if value is None:
        return "null"
    if isinstance(value, bool):
        return "true" if value else "false"
    if isinstance(value, str):
        is_name = is_plain_text(value) and not set(value) & set(" =$()'")
        return value if is_name else _quoted(value)
    if isinstance(value, int):
        return repr(value)
    if not math.isfinite(value):
        return ".nan" if math.isnan(value) else ".inf" if value > 0 else "-.inf"
    # YAML 1.1 reads '1e-05' as a text.
    mantissa, exponent, power = repr(value).partition("e")
    return f"{mantissa}.0e{power}" if exponent and "." not in mantissa else repr(value)


def _quoted(text: str) -> str:
    return f'"{"".join(map(_character, text))}"'


def _character(character: str) -> str:
    if character in '"\\':
        return f"\\{character}"
    return character if character.isprintable() else f"\\U{ord(character):08X}"
