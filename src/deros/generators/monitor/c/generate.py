"""``deros`` to ``c``: the monitor as two files of freestanding C99."""

from __future__ import annotations

from deros.generators.api.protocol import Context, File, Files, GenerationError
from deros.generators.monitor.c.render import render_monitor
from deros.models.rules import Rules


def generate(model: Rules, context: Context) -> Files:
    """Return the header and the source of the monitor that runs ``model``.

    Raises:
        GenerationError: if the rules have an error, or need more than a monitor of fixed size.
    """
    built = context.build(model)
    if built.program is None:
        raise GenerationError(built.diagnostics)
    return {name: File(text) for name, text in render_monitor(built.program).items()}
