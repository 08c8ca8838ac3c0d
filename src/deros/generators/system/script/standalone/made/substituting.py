"""Parameter files in which $(...) and <...> stand for values that the system gives."""

from __future__ import annotations

from collections.abc import Callable, Mapping
import re

_USE = re.compile(
    r"""\$\((?:var +(?P<var>[^\s()'"]+)"""
    r"""|env +(?P<env>[A-Za-z_]\w*)(?: +(?P<default>[^\s()'"]*))?"""
    r"""|find-pkg-share +(?P<package>\w+)) *\)""",
    re.ASCII,
)
_MEANT_BY_YAML = re.compile(
    '[\x00-\x1f\x7f-\x9f\u2028\u2029\ud800-\udfff\ufeff\ufffe\uffff"\'\\\\#,\\[\\]{}]'
    r'|\A[ &*!|>%@`?]|\A-(?= |\Z)|:(?= |\Z)| \Z'
)
_LOOKS_LIKE_COMMENT = re.compile(r'(?:\A|.*[ \t])#')


def substituted(
    text: str,
    given: Mapping[str, str],
    environment: Mapping[str, str],
    share: Callable[[str], str],
) -> str:
    """
    Return a text with values in place of $(var NAME), $(env NAME) and $(find-pkg-share PACKAGE).

    What is given for a name in angle brackets is put in place of that very text.
    Raise ValueError if one of them has no value, or one that YAML would take for something else.
    What looks like a comment may speak of others.
    """

    def is_in_comment(position: int) -> bool:
        start = text.rfind('\n', 0, position) + 1
        return _LOOKS_LIKE_COMMENT.match(text[start:position]) is not None

    def value(use: re.Match[str]) -> str:
        if use['package'] is not None:
            found = share(use['package'])
        elif use['var'] is not None:
            if use['var'] not in given and is_in_comment(use.start()):
                return use[0]
            if use['var'] not in given:
                raise ValueError(f'the system gives no value for {use[0]}')
            found = given[use['var']]
        else:
            if use['default'] is None and use['env'] not in environment:
                raise ValueError(f'the environment variable {use["env"]!r} is not set')
            found = environment.get(use['env'], use['default'])
        return one_value(use[0], found)

    def one_value(name: str, found: str) -> str:
        if _MEANT_BY_YAML.search(found):
            raise ValueError(f'{name} is {found!r}, which would not be one value of YAML')
        return found

    for found in re.finditer(r'\$\(', text):
        if _USE.match(text, found.start()) is None and not is_in_comment(found.start()):
            raise ValueError('there is something behind $( that cannot be substituted')
    made = _USE.sub(value, text)
    for name in given:
        if name.startswith('<') and name in made:
            made = made.replace(name, one_value(name, given[name]))
    return made
