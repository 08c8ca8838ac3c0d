"""Parameter files whose keys are moved below a namespace."""

from __future__ import annotations

import re

from .under import put_under

_PLACE_OF_KEYS = re.compile(r'/|/?[A-Za-z_]\w*(?:/[A-Za-z_]\w*)*', re.ASCII)


def moved(text: str, namespace: str) -> str:
    """
    Return the text of a parameter file with all of its keys below a namespace.

    Raise ValueError if that is not a namespace.
    """
    if _PLACE_OF_KEYS.fullmatch(namespace) is None:
        raise ValueError(f'{namespace!r} is not a namespace, such as front or /arm/left')
    return put_under(text, (namespace,))
