"""elkjs, the layout engine of the page: the Eclipse Layout Kernel for browsers, under EPL-2.0.

It is a package of npm, not part of this repository. A release of deros contains it, since
``make`` fetches it before the release is built; see ``tools/fetch_elkjs.py``.
"""

from __future__ import annotations

from importlib.resources import files
from pathlib import Path

VERSION = "0.12.1"
DIGEST = "b1032b7cfd2a57c54c6f0e8369d7665e19a579954f7cd20a6dae28f1912ea0d7"
"""SHA-256 of ``lib/elk.bundled.js`` in that version."""

FILE = "elk.bundled.js"

_SOURCE = f"""\
/* elkjs {VERSION}, https://github.com/kieler/elkjs, used under the Eclipse Public License 2.0,
   https://www.eclipse.org/legal/epl-2.0/; its source code is to be had there. */
"""


class NoElkjs(Exception):  # noqa: N818 - a fault of the installation or the call, which says all
    """There is no elkjs, or a file that cannot be it; the message says what to do."""


def read_elkjs(path: Path | None = None) -> str:
    """Return the text of elkjs for the page.

    Args:
        path: of ``elk.bundled.js``; by default, that of this installation.

    Raises:
        NoElkjs: there is none, or the text cannot stand in a page.
    """
    found = path or files(__package__) / "assets" / "elkjs" / FILE
    try:
        text = found.read_text(encoding="ascii")
    except FileNotFoundError:
        where = f"'{path}' does not exist" if path else "this installation has no elkjs"
        raise NoElkjs(
            f"{where}, which lays the page out; get it with 'npm pack elkjs@{VERSION}', unpack that"
            f" and name its package/lib/{FILE} with --elkjs"
        ) from None
    except (OSError, UnicodeDecodeError) as fault:
        raise NoElkjs(f"cannot read '{found}' as elkjs: {fault}") from None
    if "ELK" not in text or "</script" in text:
        raise NoElkjs(f"'{found}' is not elkjs: name package/lib/{FILE} of the npm package")
    return _SOURCE + text
