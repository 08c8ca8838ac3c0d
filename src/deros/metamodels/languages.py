"""The textX metamodels of the three languages, each built once per process.

The grammars (``*.tx`` beside this file) are the languages.
"""

from __future__ import annotations

import functools
from pathlib import Path
from typing import Any, Literal

from textx import metamodel_from_file

from deros.metamodels.matching import make_quick
from deros.metamodels.scoping import SCOPE_PROVIDERS

Language = Literal["rosnode", "rossystem", "deros"]

LANGUAGES: dict[str, Language] = {".rnd": "rosnode", ".system": "rossystem", ".deros": "deros"}
"""The language of a file, by the suffix of its name."""


def language_of(path: str) -> Language | None:
    """Return the language that a file's suffix stands for, or ``None``."""
    return LANGUAGES.get(Path(path).suffix)


@functools.cache
def metamodel(language: Language) -> Any:
    """Return the textX metamodel of a language, as textX and tools built on it use it.

    Where a model names an element of another file, it holds a
    :class:`~deros.metamodels.scoping.Reference`.
    """
    result = metamodel_from_file(
        str(Path(__file__).with_name(f"{language}.tx")), auto_init_attributes=False, autokwd=True
    )
    result.register_scope_providers(dict(SCOPE_PROVIDERS))
    return result


@functools.cache
def quick_metamodel(language: Language) -> Any:
    """Return the metamodel that the loader uses: it parses prepared text, without comments, fast.

    The values in its models are :class:`~deros.metamodels.matching.Token` objects, which know their
    places; textX itself keeps the places of objects only.
    """
    result = metamodel.__wrapped__(language)
    result._parser_blueprint.comments_model = None
    make_quick(result)
    return result
