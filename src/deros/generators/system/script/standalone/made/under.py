"""Texts of YAML that are put under further keys."""

from __future__ import annotations

import re

# A line of YAML ends where the parser of ROS 2 says so: the line ends of Unicode are among these.
_LINE = re.compile('([^\r\n\x85\u2028\u2029]*)(\r\n|[\r\n\x85\u2028\u2029]|\\Z)')
_EDGE_OF_DOCUMENT = re.compile(r'(---|\.\.\.)(?![^ \t])')


def put_under(text: str, keys: tuple[str, ...]) -> str:
    """
    Return a text of YAML with all that is in it under keys, the outermost first.

    The text is moved to the right, so that each value stays as it is spelled.
    """
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
