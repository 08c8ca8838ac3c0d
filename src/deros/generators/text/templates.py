"""The Jinja environment of all templates: strict and deterministic."""

from __future__ import annotations

import functools
from typing import TYPE_CHECKING
from xml.sax.saxutils import escape

if TYPE_CHECKING:
    from jinja2 import Environment


@functools.cache
def environment(package: str) -> Environment:
    """Return the environment for the folder ``templates`` of a Python package.

    An undefined name is an error instead of an empty text, and lines with nothing but a block tag
    leave no empty line. The filters are ``literal`` (a Python literal) and ``xml`` (text of an XML
    element or attribute).
    """
    import jinja2

    result = jinja2.Environment(
        loader=jinja2.PackageLoader(package, "templates"),
        undefined=jinja2.StrictUndefined,
        trim_blocks=True,
        lstrip_blocks=True,
        keep_trailing_newline=True,
        autoescape=False,  # most targets are not markup; XML uses the filter
    )
    result.filters["literal"] = repr
    result.filters["xml"] = xml_text
    return result


def xml_text(text: str) -> str:
    """Return ``text`` escaped for an XML element or a quoted attribute."""
    return escape(text, {'"': "&quot;"})
