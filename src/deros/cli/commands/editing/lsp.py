"""``deros lsp``: serve an editor over the Language Server Protocol."""

from __future__ import annotations

import os
import sys
from pathlib import Path

import click

from deros.cli.options import interfaces_option
from deros.cli.streams import say
from deros.pipeline.outcome import UNUSABLE

_SWITCH_SECONDS = 0.0005
_NEEDS = "deros: the language server needs pygls: pip install 'deros[lsp]'"


@click.command()
@interfaces_option
@click.pass_context
def lsp(ctx: click.Context, interfaces: tuple[Path, ...]) -> None:
    """Serve an editor over the Language Server Protocol.

    Editors start it themselves and talk to it on standard input and output.
    """
    try:
        import pygls  # noqa: F401
    except ImportError:
        say(_NEEDS, to=sys.stderr)
        ctx.exit(UNUSABLE)
    from deros.lsp.serving import make_server, prepare

    # Who types does not wait for the thread that analyses.
    sys.setswitchinterval(_SWITCH_SECONDS)
    # The protocol has the streams for itself: what anything else prints goes to the log.
    stdin, stdout = os.fdopen(os.dup(0), "rb"), os.fdopen(os.dup(1), "wb")
    os.dup2(2, 1)
    server = make_server(interfaces)
    server.prepare(prepare)
    server.start_io(stdin, stdout)
