"""Licence and copyright notices of generated files, from the options of the generators."""

from __future__ import annotations

import re

from deros.generators.api.protocol import OptionError, Options

APACHE = "Apache-2.0"
"""The default licence of packages."""

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
        OptionError: if it contains a character that is not allowed in SPDX expressions.
    """
    text = options.get("licence", APACHE).strip()
    if _LICENCE.fullmatch(text) is None:
        raise OptionError(f"licence {text!r} is not an SPDX identifier such as BSD-3-Clause")
    return text


def notice(options: Options) -> str:
    """Return the notice for the top of each file, or '' if there is no copyright holder.

    For the Apache License it is the text that the licence asks for, for any other licence the SPDX
    identifier.

    Raises:
        OptionError: if an option cannot be part of a comment.
    """
    holder = " ".join(options.get("copyright", "").split())
    if not holder:
        return ""
    if not holder.isprintable() or holder.endswith(("\\", "??/")):
        raise OptionError(f"copyright {holder!r} cannot be part of a comment")
    named = licence(options)
    body = _APACHE_TEXT if named == APACHE else f"SPDX-License-Identifier: {named}"
    return f"Copyright {holder}\n\n{body}"


def is_checked(text: str) -> bool:
    """Return whether ament_copyright recognizes a notice: only that of the Apache License."""
    return text.endswith(_APACHE_TEXT)


def licensed_python(text: str, notice: str) -> str:
    """Return a text whose comments start with ``#`` with its notice above it."""
    return _above(text, notice, "#")


def licensed_cpp(text: str, notice: str) -> str:
    """Return a C or C++ file with its notice above it, or with a reference to package.xml."""
    if not notice:
        return f"// Copyright and licence: see package.xml.\n\n{text}"
    return _above(text, notice, "//")


def _above(text: str, notice: str, mark: str) -> str:
    if not notice:
        return text
    lines = [f"{mark} {line}".rstrip() for line in notice.splitlines()]
    return "\n".join([*lines, "", text])
