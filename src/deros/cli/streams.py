"""What becomes of output that cannot be written: characters that its encoding lacks, a full disk.

Words must reach their reader on any terminal, and in any log: a finding is never lost because the
output has no arrow. So a character that the encoding lacks is written as others that resemble it.
None of those has a meaning inside of a string of JSON, which stays valid.
"""

from __future__ import annotations

import codecs
import errno
import io
import os
import sys
import unicodedata
from typing import TYPE_CHECKING, TextIO

if TYPE_CHECKING:
    from rich.console import Console

_READABLE = "deros.readable"

_PLAIN = {
    "\N{RIGHTWARDS ARROW}": "->",
    "\N{LEFTWARDS ARROW}": "<-",
    "\N{LEFT DOUBLE QUOTATION MARK}": "'",
    "\N{RIGHT DOUBLE QUOTATION MARK}": "'",
    "\N{LEFT SINGLE QUOTATION MARK}": "'",
    "\N{RIGHT SINGLE QUOTATION MARK}": "'",
    "\N{EN DASH}": "-",
    "\N{EM DASH}": "-",
    "\N{MIDDLE DOT}": "*",
    "\N{DOT OPERATOR}": "*",
    "\N{MULTIPLICATION SIGN}": "x",
    "\N{GREATER-THAN OR EQUAL TO}": ">=",
    "\N{LESS-THAN OR EQUAL TO}": "<=",
    "\N{DEGREE SIGN}": "deg",
    "\N{MICRO SIGN}": "u",
    "\N{GREEK SMALL LETTER MU}": "u",
    "\N{OHM SIGN}": "Ohm",
    "\N{GREEK CAPITAL LETTER OMEGA}": "Ohm",
    "\N{SUPERSCRIPT MINUS}": "-",
    "\N{BOX DRAWINGS LIGHT VERTICAL}": "|",
    "\N{BOX DRAWINGS LIGHT HORIZONTAL}": "-",
    "\N{BOX DRAWINGS HEAVY HORIZONTAL}": "-",
    "\N{BULLET}": "*",
    "\N{CHECK MARK}": "+",
    "\N{BALLOT X}": "x",
}
"""How a character is written where it cannot be; others lose their accents, or become a ``?``."""

_NO_TERMINAL = 100_000
"""Columns of an output that is no terminal: nothing is wrapped there."""

_NO_ROOM = frozenset({errno.ENOSPC, errno.EDQUOT, errno.EIO, errno.EFBIG})


def write_readably() -> None:
    """Write what the encoding of the output lacks by other characters from now on."""
    for stream in (sys.stdout, sys.stderr):
        if isinstance(stream, io.TextIOWrapper):
            stream.reconfigure(errors=_READABLE)


def say(text: str, *, end: str = "\n", to: TextIO | None = None) -> None:
    """Write words to a stream, standard output unless another is named, at once.

    ``click.echo`` is not used: it writes UTF-8 where the output asks for ASCII.
    """
    print(text, end=end, file=to or sys.stdout, flush=True)


def console() -> Console:
    """Return a console of rich on standard output, for tables.

    Where the output is no terminal, nothing is wrapped or cut off. NO_COLOR is obeyed.
    """
    from rich.console import Console

    width = None if sys.stdout.isatty() else _NO_TERMINAL
    no_color = bool(os.environ.get("NO_COLOR"))
    return Console(file=sys.stdout, width=width, no_color=no_color, emoji=False, highlight=False)


def is_lost_output(error: OSError) -> bool:
    """Whether an error shows that the output cannot be written, rather than a file of its own."""
    return error.errno in _NO_ROOM and error.filename is None


def discard_output() -> None:
    """Discard further output: what cannot be written would raise once more at exit."""
    os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())


def _readable(error: UnicodeError) -> tuple[str, int]:
    assert isinstance(error, UnicodeEncodeError)
    lacking = error.object[error.start : error.end]
    return "".join(map(_plain, lacking)), error.end


def _plain(character: str) -> str:
    if character in _PLAIN:
        return _PLAIN[character]
    decomposed = unicodedata.normalize("NFKD", character)
    return "".join(each for each in decomposed if each.isascii()) or "?"


codecs.register_error(_READABLE, _readable)
