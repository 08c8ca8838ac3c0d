"""The text of a page: one file that needs nothing else, and asks for nothing.

Its policy lets the browser run the scripts that are in it by their digests, and load nothing. All
texts of the system stand in a block of JSON, which the scripts put into the page as text. The page
is ASCII, so that it stays the same in any encoding of the output.
"""

from __future__ import annotations

import base64
import dataclasses
import hashlib
import html
import json
from collections.abc import Mapping
from importlib.resources import files

from deros.diagnostics import encodable
from deros.report.page.contents import Contents

SCRIPTS = (
    "evaluate.js",
    "variant.js",
    "view.js",
    "layout.js",
    "elements.js",
    "draw.js",
    "viewport.js",
    "details.js",
    "findings.js",
    "search.js",
    "switches.js",
    "page.js",
)
"""The scripts of the page; they define functions, and the last one starts."""

_ASSETS = files(__package__) / "assets"


def render(contents: Contents, elkjs: str) -> str:
    """Return the page.

    Args:
        contents: what it shows.
        elkjs: the text of elkjs, which lays the picture out.
    """
    own = "\n".join(_asset(name) for name in SCRIPTS)
    style = _asset("page.css")
    program = f'(() => {{\n"use strict";\n{own}}})();\n'
    return _filled_in(
        _asset("page.html"),
        {
            "title": _escaped(contents.name),
            "policy": _policy((elkjs, program), style),
            "style": style,
            "contents": _json(contents),
            "elkjs": elkjs,
            "program": program,
        },
    )


def _asset(name: str) -> str:
    return (_ASSETS / name).read_text(encoding="utf-8")


def _filled_in(template: str, values: Mapping[str, str]) -> str:
    """Put values in place of ``{{name}}``, each once; what looks like one in a value stays."""
    pieces = []
    rest = template
    for name, value in values.items():
        before, _, rest = rest.partition("{{" + name + "}}")
        pieces += [before, value]
    return "".join((*pieces, rest))


def _policy(scripts: tuple[str, ...], style: str) -> str:
    """Return a content security policy that lets just these texts run."""
    allowed = " ".join(map(_digest, scripts))
    return f"default-src 'none'; script-src {allowed}; style-src {_digest(style)}"


def _digest(text: str) -> str:
    digest = hashlib.sha256(text.encode()).digest()
    return f"'sha256-{base64.b64encode(digest).decode()}'"


def _json(contents: Contents) -> str:
    """Return the contents, without a character that could end the element around them."""
    text = json.dumps(dataclasses.asdict(contents), separators=(",", ":"))
    return text.replace("<", "\\u003c").replace(">", "\\u003e").replace("&", "\\u0026")


def _escaped(text: str) -> str:
    return html.escape(encodable(text)).encode("ascii", "xmlcharrefreplace").decode()
