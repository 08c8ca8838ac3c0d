"""Parameter files whose keys are moved below a namespace."""

from __future__ import annotations

import re

# A line of YAML ends where the parser of ROS 2 says so: the line ends of Unicode are among these.
_LINE = re.compile('([^\r\n\x85\u2028\u2029]*)(\r\n|[\r\n\x85\u2028\u2029]|\\Z)')
_EDGE_OF_DOCUMENT = re.compile(r'(---|\.\.\.)(?![^ \t])')
_PLACE_OF_KEYS = re.compile(r'/|/?[A-Za-z_]\w*(?:/[A-Za-z_]\w*)*', re.ASCII)


def moved(text: str, namespace: str) -> str:
    """
    Return the text of a parameter file with all of its keys below a namespace.

    The text is moved to the right below one more key, so that each value stays as it is spelled;
    raise ValueError if that is not a namespace.
    """
    if _PLACE_OF_KEYS.fullmatch(namespace) is None:
        raise ValueError(f'{namespace!r} is not a namespace, such as front or /arm/left')
    lines = []
    is_inside = False  # of a document, behind its first key
    for line, end in _LINE.findall(text.removeprefix('\ufeff')):
        edge = _EDGE_OF_DOCUMENT.match(line)
        rest = line[3:].strip(' \t') if edge else ''
        if edge:
            is_inside = edge[1] == '---' and rest[:1] not in ('', '#')
            if is_inside:
                line = f'---\n{namespace}:{line[3:]}'
        elif is_inside:
            line = f'  {line}' if line else ''
        elif not line.startswith('%') and line.strip(' \t')[:1] not in ('', '#'):
            line = f'{namespace}:\n  {line}'
            is_inside = True
        lines.append(line + end)
    return ''.join(lines)
