"""Texts of YAML that are put under further keys."""

from __future__ import annotations

from collections.abc import Iterator
import re
from typing import Any

# A line of YAML ends where the parser of ROS 2 says so: the line ends of Unicode are among these.
_LINE = re.compile('([^\r\n\x85\u2028\u2029]*)(\r\n|[\r\n\x85\u2028\u2029]|\\Z)')
_EDGE_OF_DOCUMENT = re.compile(r'(---|\.\.\.)(?![^ \t])')


def put_under(text: str, keys: tuple[str, ...]) -> str:
    """
    Return a text of YAML with all that is in it under keys, the outermost first.

    The text is moved to the right, so that each value stays as it is spelled. Raise ValueError if
    ROS 2 could take one of its keys for a part of another one then.
    """
    if len(keys) != 2:  # the parameters of a plain file are read as those at the top
        _check_keys(text, '/' if len(keys) == 1 else '.')
    above = '\n'.join(f'{"  " * depth}{key}:' for depth, key in enumerate(keys))
    indent = '  ' * len(keys)
    lines = []
    is_inside = False  # of a document, behind its first key
    for line, end in _LINE.findall(text.removeprefix('\ufeff')):
        edge = _EDGE_OF_DOCUMENT.match(line)
        rest = line[3:].strip(' \t') if edge else ''
        if edge:
            is_inside = edge[1] == '---' and rest[:1] not in ('', '#')
            if is_inside:
                line = f'---\n{above}{line[3:]}'
        elif is_inside:
            line = indent + line if line else ''
        elif not line.startswith('%') and line.strip(' \t')[:1] not in ('', '#'):
            line = f'{above}\n{indent}{line}'
            is_inside = True
        lines.append(line + end)
    return ''.join(lines)


def _check_keys(text: str, separator: str) -> None:
    """
    Raise ValueError if ROS 2 could take a key at the top for a part of one before it.

    At the end of what is below a key, ROS 2 takes away one name: of a key such as front/arm, only
    the last one, and behind an empty mapping of parameters one that is not of it. At the top of a
    file it forgets all of them, but not where that is put under keys.
    """
    try:
        import yaml
    except ImportError:  # it comes with ROS 2; without it, the text is taken as it is
        return
    loader = getattr(yaml, 'CSafeLoader', yaml.SafeLoader)  # in C it is the parser of ROS 2
    try:
        documents = list(yaml.compose_all(text, Loader=loader))
    except (yaml.YAMLError, RecursionError):
        return  # ROS 2 says what is wrong with it
    for document in documents:
        if not isinstance(document, yaml.MappingNode) or not document.value:
            continue
        *others, last = document.value
        found = [each for other in others for each in _mappings(*other)]
        joined = [key for key, inner in found if separator in key]
        if separator == '.':
            joined += [key for key, inner in found if not inner]
            joined += [key for key, inner in _mappings(*last) if not inner][1:]
        if joined:
            names = [f'"{n}"' if n[0] == '*' else n for n in joined[0].split(separator) if n]
            nested = ': {'.join(names) + ': ...' + '}' * (len(names) - 1)
            hint = f'write {nested}' if len(names) > 1 else 'it needs a value'
            raise ValueError(f'ROS 2 would take keys behind {joined[0]!r} for parts of it: {hint}')


def _mappings(key: Any, value: Any) -> Iterator[tuple[str, list[Any]]]:
    """Yield the keys that have a mapping behind them, with that; none of parameters of a node."""
    if value.id == 'mapping' and key.value != 'ros__parameters':
        yield str(key.value), value.value  # ROS 2 refuses keys that are no texts
        for inner in value.value:
            yield from _mappings(*inner)
