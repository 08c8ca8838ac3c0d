"""The text of the C monitor: a header and a source."""

from __future__ import annotations

import re

from deros.generators.monitor_c.deviations import DEVIATIONS
from deros.generators.monitor_c.fitting import fitted
from deros.generators.monitor_c.helpers import helper_texts
from deros.generators.monitor_c.proof import NO_CONTRACT, proof_of
from deros.generators.monitor_c.view import MonitorView, monitor_view
from deros.generators.templates import environment
from deros.monitor.ir import Program

_OF_LIBM = re.compile(r"\b(?:NAN|INFINITY|fabs|sqrt|atan2|asin|fmod)\b")


def render_monitor(program: Program) -> dict[str, str]:
    """Return the texts of the header and the source of a program's monitor, by their names.

    Both are freestanding C99; the mathematical library is needed by what the rules use of it alone.

    Raises:
        GenerationError: what a rule compares has no place in a monitor of fixed size.
    """
    view = monitor_view(program)
    header = _template("monitor.h.j2", monitor=view)
    texts = {f"{view.prefix}_monitor.h": header, f"{view.prefix}_monitor.c": _source(view)}
    return {name: fitted(text) for name, text in texts.items()}


def _source(view: MonitorView) -> str:
    proof = proof_of(view)
    body = _template("body.c.j2", monitor=view, proof=proof)
    body = re.sub(rf"^ *{re.escape(NO_CONTRACT)}\n", "", body, flags=re.MULTILINE)
    texts = [_named(each, view) for each in helper_texts(view.program, body)]
    helpers = "".join(f"{each}\n" for each in texts)
    return _template(
        "monitor.c.j2",
        monitor=view,
        deviations=DEVIATIONS,
        needs_math=_OF_LIBM.search(body + helpers) is not None,
        declarations=proof.declarations,
        helpers=helpers,
        body=body,
    )


def _named(text: str, view: MonitorView) -> str:
    return text.replace("@_", f"{view.prefix}_").replace("$_", f"{view.macro}_")


def _template(name: str, **names: object) -> str:
    loaded = environment("deros.generators.monitor_c").get_template(name)
    text: str = loaded.render(names)
    return text
