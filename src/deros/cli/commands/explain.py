"""``deros explain``: show the page of a diagnostic code."""

from __future__ import annotations

import os
import re
import sys
from importlib import resources
from typing import TYPE_CHECKING

import click

from deros.cli.streams import say
from deros.pipeline.outcome import UNUSABLE

if TYPE_CHECKING:
    from deros.diagnostics import Code

_LINK = re.compile(r"\[([^\]]+)\]\([^)\s]+\)")
_FENCE = "```"


def _complete(ctx: click.Context, param: click.Parameter, incomplete: str) -> list[str]:
    """Complete codes and slugs for the shell."""
    del ctx, param
    from deros.codes import ALL_CODES, SLUGS

    return [each for each in (*ALL_CODES, *SLUGS) if each.lower().startswith(incomplete.lower())]


@click.command()
@click.argument("codes", nargs=-1, metavar="[CODE]...", shell_complete=_complete)
@click.pass_context
def explain(ctx: click.Context, codes: tuple[str, ...]) -> None:
    """Explain findings: what each code means, why it matters, an example, and what to do.

    CODE is a code such as DRS317, its number, or its slug such as input-without-timeout. Without a
    CODE, all of them are listed.
    """
    if not codes:
        say(_listing(), end="")
        return
    known = [(each, find(each)) for each in codes]
    for word, code in known:
        if code is None:
            say(_unknown(word), to=sys.stderr)
    if any(code is None for _, code in known):
        ctx.exit(UNUSABLE)
    show("\n".join(page(code) for _, code in known if code is not None))


def find(word: str) -> Code | None:
    """Return the code that a word names: ``DRS317``, ``drs317``, ``317`` or its slug."""
    from deros.codes import ALL_CODES, SLUGS

    plain = word.strip().lower()
    if number := re.fullmatch(r"(?:drs[-_]?)?0*(\d{1,3})", plain):
        return ALL_CODES.get(f"DRS{int(number[1]):03d}")
    return SLUGS.get(plain.replace("_", "-"))


def page(code: Code) -> str:
    """Return the page of a code, in Markdown."""
    return (resources.files("deros") / "pages" / f"{code.name}.md").read_text(encoding="utf-8")


def show(text: str) -> None:
    """Write Markdown to standard output, laid out if that is a terminal."""
    if not sys.stdout.isatty():
        say(text, end="")
        return
    from rich.console import Console
    from rich.markdown import Markdown

    console = Console(no_color=bool(os.environ.get("NO_COLOR")), emoji=False)
    console.print(Markdown(without_links(text), code_theme="ansi_dark", hyperlinks=False))


def without_links(text: str) -> str:
    """Return Markdown with the text of each link alone: a terminal has no other pages."""
    pieces = text.split(_FENCE)
    pieces[::2] = [_LINK.sub(r"\1", piece) for piece in pieces[::2]]
    return _FENCE.join(pieces)


def _listing() -> str:
    from deros.codes import ALL_CODES, SLUGS

    width = max(map(len, SLUGS))
    return "".join(
        f"{code.name}  {code.slug:<{width}}  {code.title}\n" for code in ALL_CODES.values()
    )


def _unknown(word: str) -> str:
    from deros.validators.findings.hints import unknown_code

    return f"deros: there is no diagnostic '{word}'; {unknown_code(word)}"
