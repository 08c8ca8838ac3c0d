"""The one way templates are set up: strict, deterministic, and without logic of their own."""

from __future__ import annotations

import functools
from typing import TYPE_CHECKING
from xml.sax.saxutils import escape

if TYPE_CHECKING:
    from jinja2 import Environment


@functools.cache
def environment(package: str) -> Environment:
    """Return the environment for the folder ``templates`` of a Python package.

    A name that the view does not define is an error, not an empty text; lines that hold only a
    block leave no line behind. The filters are ``literal`` (a Python literal) and ``xml`` (text of
    an XML element or attribute).
    """
    import jinja2

    made = jinja2.Environment(
        loader=jinja2.PackageLoader(package, "templates"),
        undefined=jinja2.StrictUndefined,
        trim_blocks=True,
        lstrip_blocks=True,
        keep_trailing_newline=True,
        autoescape=False,  # most targets are no markup; XML uses the filter
    )
    made.filters["literal"] = repr
    made.filters["xml"] = xml_text
    return made


def xml_text(text: str) -> str:
    """Escape ``text`` for an XML element or a quoted attribute."""
    return escape(text, {'"': "&quot;"})
