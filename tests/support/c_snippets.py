"""Snippets of generated C, one for each construct, short enough to review.

Each is of the smallest rules that use the construct, and shows what these add to the snippets
before it. Whether together they show all that a monitor may have, ``c_shapes`` tells.
"""

from __future__ import annotations

import difflib
import functools
import re
from collections.abc import Iterator, Mapping
from dataclasses import dataclass

from deros.generators.monitor.c.interface import render_monitor
from tests.support.c_everything import built
from tests.support.tables import rows


@dataclass(frozen=True)
class Snippet:
    """What is shown of the monitor of some rules, beside what has a name of its own.

    Attributes:
        rules: the rules.
        shown: names of functions, types and tables whose text differs from that shown before.
    """

    rules: str
    shown: tuple[str, ...]


STOP = "if e.r then { stop; };"
SMALLEST = "smallest"
SMALLEST_RULES = f"action stop; input v = topic /flag.data entity e {{ r: v; }} {STOP}"


SNIPPETS = {
    each["construct"]: Snippet(each["rules"], tuple(each["shown"].split()))
    for each in rows("constructs", "Code in C")
}
"""Constructs by name."""

KINDS = (
    (
        r"(judge_by|judge|behave|settle|forget|which|expire|observe|after|take|compute|arguments"
        r"|small_on|small_latch|small_enable)_(?!all\b)\w+",
        r"\1",
    ),
    (r"(least|greatest|are_numbers|points_in|is_in)_\w+", r"\1"),
)
"""Names that come from rules in part, and that part left out."""


@functools.cache
def texts(rules: str) -> Mapping[str, str]:
    """Return the header and the source of the monitor of some rules, by the end of their names."""
    made = render_monitor(built(f'use "robot.system" import Robot\n{rules}', "small"))
    return {end: made[f"small_monitor.{end}"] for end in ("h", "c")}


def shown() -> dict[str, dict[str, str]]:
    """Return what each snippet is to show: blocks of the source or the header, by their names.

    The smallest monitor is shown whole. A snippet shows what it lists, and the first block of a
    kind wherever that appears.

    Raises:
        AssertionError: something to be shown is not there.
    """
    made = {SMALLEST: _blocks(SMALLEST_RULES)}
    kinds = {kind_of(each) for each in made[SMALLEST]}
    for name, each in SNIPPETS.items():
        blocks = _blocks(each.rules)
        assert set(each.shown) <= set(blocks), sorted(blocks)
        made[name] = {
            key: block
            for key, block in blocks.items()
            if key in each.shown or kind_of(key) not in kinds
        }
        kinds |= {kind_of(key) for key in made[name]}
    return made


def snippets() -> dict[str, str]:
    """Return the text of each snippet, by its name.

    Of two blocks of a kind, the second one has the number of lines in place of those that both
    have. So a change of what they share is read once.
    """
    before: dict[str, dict[str, list[str]]] = {}
    made: dict[str, str] = {}
    for name, blocks in shown().items():
        parts = []
        for key, block in blocks.items():
            alike = before.setdefault(kind_of(key), {})
            parts.append(_shortened(_bare(block), alike) if alike else block)
            alike.setdefault(name, _bare(block))
        if name in SNIPPETS:
            made[name] = "\n\n".join([f"/* {SNIPPETS[name].rules} */", *parts]) + "\n"
    return made


def _shortened(lines: list[str], before: Mapping[str, list[str]]) -> str:
    """Return a block with the number of lines in place of those that another one has as well.

    Args:
        lines: of the block.
        before: the blocks of its kind, by the snippets that show them.
    """
    matchers = {name: difflib.SequenceMatcher(None, other, lines) for name, other in before.items()}
    name = max(matchers, key=lambda each: matchers[each].ratio())
    body = lines.index("{") + 1 if "{" in lines and lines[0] != "typedef struct" else 0
    text = lines[:body]
    for what, _, _, start, end in matchers[name].get_opcodes():
        start, end = max(start, body), min(end, len(lines) - 1)
        is_long = what == "equal" and end - start > 1
        text += [f"  /* {end - start} lines of {name} */"] if is_long else lines[start:end]
    return "\n".join([*text, lines[-1]])


def _bare(block: str) -> list[str]:
    """Return the lines of a block without what they quote of the rules."""
    return re.sub(r"^ */\*[^@].*?\*/\n", "", block, flags=re.DOTALL | re.MULTILINE).splitlines()


def kind_of(name: str) -> str:
    """Return the name of a function, type or table without what comes from the rules."""
    for pattern, form in KINDS:
        name = re.sub(pattern, form, name)
    return name


_NAMED = re.compile(
    r"^(?:\} (\w+);$|#define (\w+) |(?:static )?const \w+ (\w+)\[|\w[^;{(]*?(\w+)\()",
    re.MULTILINE,
)


def _blocks(rules: str) -> dict[str, str]:
    """Return the named blocks of the header and the source of the monitor of some rules."""
    return {name: block for text in texts(rules).values() for name, block in named(text) if name}


def named(text: str) -> Iterator[tuple[str, str]]:
    """Yield what is between empty lines, with the name that it declares or defines, if any."""
    for block in map(str.strip, text.split("\n\n")):
        match = _NAMED.search(block)
        name = next(filter(None, match.groups())) if match else ""
        yield (f"{name};" if match and match[4] and block.endswith(";") else name), block
