"""Licence and copyright of generated packages: from the options of generators to each file."""

from __future__ import annotations

import re

from deros.generators.api.protocol import Options

APACHE = "Apache-2.0"
"""The licence of packages for which none is given."""

_APACHE_TEXT = """\
Licensed under the Apache License, Version 2.0 (the "License");
you may not use this file except in compliance with the License.
You may obtain a copy of the License at

    http://www.apache.org/licenses/LICENSE-2.0

Unless required by applicable law or agreed to in writing, software
distributed under the License is distributed on an "AS IS" BASIS,
WITHOUT WARRANTIES OR CONDITIONS OF ANY KIND, either express or implied.
See the License for the specific language governing permissions and
limitations under the License."""

_LICENCE = re.compile(r"[A-Za-z0-9][A-Za-z0-9.+() -]*")


def licence(options: Options) -> str:
    """Return the licence for manifests: the option ``licence``, an SPDX expression.

    Raises:
        ValueError: if it has a character that no SPDX expression has.
    """
    text = options.get("licence", APACHE).strip()
    if _LICENCE.fullmatch(text) is None:
        raise ValueError(f"licence {text!r} does not read like an SPDX identifier: BSD-3-Clause")
    return text


def notice(options: Options) -> str:
    """Return the text above each file, or nothing if there is no copyright holder.

    The Apache License asks for its own text. Of any other licence the SPDX identifier is named.

    Raises:
        ValueError: if an option cannot stand in a comment.
    """
    holder = " ".join(options.get("copyright", "").split())
    if not holder:
        return ""
    if not holder.isprintable() or holder.endswith(("\\", "??/")):
        raise ValueError(f"copyright {holder!r} cannot stand in a comment")
    named = licence(options)
    body = _APACHE_TEXT if named == APACHE else f"SPDX-License-Identifier: {named}"
    return f"Copyright {holder}\n\n{body}"


def is_checked(text: str) -> bool:
    """Tell whether ament's own test knows a notice: that of the Apache License."""
    return text.endswith(_APACHE_TEXT)


def licensed_python(text: str, notice: str) -> str:
    """Return a module, or any text with comments like Python's, with its notice above it."""
    return _above(text, notice, "#")


def licensed_cpp(text: str, notice: str) -> str:
    """Return a C or C++ file with its notice above it; without one it refers to package.xml."""
    if not notice:
        return f"// Copyright and licence: see package.xml.\n\n{text}"
    return _above(text, notice, "//")


def _above(text: str, notice: str, mark: str) -> str:
    if not notice:
        return text
    lines = [f"{mark} {line}".rstrip() for line in notice.splitlines()]
    return "\n".join([*lines, "", text])
