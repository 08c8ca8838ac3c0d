"""How texts are spelled in a compose file: YAML, in which `$` begins a variable."""

from __future__ import annotations

from deros.generators.system.script.standalone.command_line import yaml
from deros.generators.text.yaml import is_plain_text


def literal(text: str) -> str:
    """Return a text in which compose finds no variable."""
    return text.replace("$", "$$")


def quoted(text: str) -> str:
    """Return a text of YAML in which compose finds no variable; quoted only where it has to be."""
    made = literal(text)
    return made if is_plain_text(made) and ", " not in made else yaml(made)


def block(text: str, indent: int) -> str:
    """Return a text of several lines behind a key, as a block where that says the same."""
    made = literal(text)
    lines = made.split("\n")
    is_block = len(lines) > 2 and lines[-1] == "" and lines[-2] != ""
    if not is_block or not all(_is_plain_line(line) for line in lines) or lines[0].startswith(" "):
        return yaml(made)
    return "\n".join(["|", *(" " * indent + line if line else "" for line in lines[:-1])])


def _is_plain_line(line: str) -> bool:
    return line.isprintable() and line == line.rstrip(" ") and "\ufeff" not in line
