"""The text of the C monitor: a header and a source, and a file that only proofs read."""

from __future__ import annotations

import re

from deros.generators.monitor.c.acsl.proof import NO_CONTRACT, proof_of
from deros.generators.monitor.c.code.view import MonitorView, monitor_view
from deros.generators.monitor.c.deviations import DEVIATIONS
from deros.generators.monitor.c.helpers import helper_texts
from deros.generators.monitor.c.line_wrapping import wrap_long_lines
from deros.generators.text.templates import environment
from deros.rules.program.ir import Program

_CONTRACT = re.compile(
    r"(?P<said>(?:^/\*(?!@)(?:(?!\*/).)*\*/\n)?)"
    r"^(?P<contract>/\*@(?:(?!\*/).)*\*/)\n"
    r"(?P<declared>[^{}]+?)\n\{",
    re.MULTILINE | re.DOTALL,
)
"""A function with a contract above it, from the comment to the brace."""

_OF_LIBM = re.compile(r"\b(?:NAN|INFINITY|fabs|sqrt|sin|cos|tan|atan2|asin|fmod|remainder)\b")


def render_monitor(program: Program) -> dict[str, str]:
    """Return the texts of the header and the source of a program's monitor, by their names.

    Both are freestanding C99; the mathematical library is needed by what the rules use of it alone.
    The third file holds the contracts of the functions. No compiler reads it, Frama-C does.

    Raises:
        GenerationError: what a rule compares has no place in a monitor of fixed size.
    """
    view = monitor_view(program)
    header = _template("monitor.h.j2", monitor=view)
    source, contracts = _source(view)
    texts = {
        f"{view.prefix}_monitor.h": header,
        f"{view.prefix}_monitor.c": source,
        f"{view.prefix}_contracts.h": contracts,
    }
    return {name: wrap_long_lines(text) for name, text in texts.items()}


def _source(view: MonitorView) -> tuple[str, str]:
    """Return the source, and the contracts of its functions, with what they are to do above them.

    Templates have each contract above its function; apart from it they are read with the rules in
    the other hand, and the code is half as long.
    """
    proof = proof_of(view)
    body = _template("body.c.j2", monitor=view, proof=proof)
    body = re.sub(rf"^ *{re.escape(NO_CONTRACT)}\n", "", body, flags=re.MULTILINE)
    texts = [_named(each, view) for each in helper_texts(view.program, body)]
    text = "".join(f"{each}\n" for each in texts) + body
    source = _template(
        "monitor.c.j2",
        monitor=view,
        deviations=[each for each in DEVIATIONS if view.constants or not each.of_constants],
        needs_math=_OF_LIBM.search(text) is not None,
        functions=_CONTRACT.sub(lambda each: each["said"] + each["declared"] + "\n{", text),
    )
    contracts = _template(
        "contracts.h.j2",
        monitor=view,
        declarations=proof.declarations,
        functions=[each.groupdict() for each in _CONTRACT.finditer(text)],
    )
    return source, contracts


def _named(text: str, view: MonitorView) -> str:
    return text.replace("@_", f"{view.prefix}_").replace("$_", f"{view.macro}_")


def _template(name: str, **names: object) -> str:
    loaded = environment("deros.generators.monitor.c").get_template(name)
    text: str = loaded.render(names)
    return text
