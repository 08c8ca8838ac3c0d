"""``$(command 'xacro …')``: texts that xacro makes of files."""

from __future__ import annotations

from typing import NamedTuple

from deros.generators.node.description import parameter_name
from deros.importers.launch.values.conditions import literally, text_of
from deros.importers.launch.values.expressions import Expressions, with_programs
from deros.importers.launch.values.substitutions import (
    InexpressibleError,
    Substitution,
    pieces_of,
)
from deros.importers.launch.values.writing import Writer
from deros.models.arguments import Expression, Interpolation, Literally, merged
from deros.names.names import check_parameter_name


class XacroCall(NamedTuple):
    """A file, and the arguments that xacro is given for it."""

    path: Expression
    arguments: tuple[tuple[str, Expression], ...]

    def write(self, writer: Writer) -> str:
        """Return the value of a parameter."""
        given = (f"{parameter_name(name)} = {writer.passed(e)}" for name, e in self.arguments)
        inside = f" ({', '.join(given)})" if self.arguments else ""
        return f"from xacro {writer.text(self.path)}{inside}"


def xacro_call(text: str, read: Expressions) -> XacroCall | None:
    """Return how xacro makes a text; ``None`` if another program does, or none.

    Raises:
        InexpressibleError: a model cannot say it.
    """
    pieces = pieces_of(text.strip())
    if len(pieces) != 1:
        return None
    (found,) = pieces
    if not isinstance(found, Substitution) or found.name != "command" or not found.operands:
        return None
    program, *words = read.words(with_programs(found.operands[0])) or [literally("")]
    is_xacro = isinstance(program, Literally) and str(program.value).split("/")[-1] == "xacro"
    words = [e for e in words if not (isinstance(e, Literally) and e.value == "--inorder")]
    if not is_xacro or not words:
        return None
    path, *others = words
    return XacroCall(read.path_of(path), tuple(map(_argument, others)))


def _argument(word: Expression) -> tuple[str, Expression]:
    """Return the name and the value of ``name:=value``."""
    pieces = word.pieces if isinstance(word, Interpolation) else merged((word,))
    first = pieces[0] if pieces else ""
    name, mark, rest = first.partition(":=") if isinstance(first, str) else ("", "", "")
    if not mark or check_parameter_name(name):
        raise InexpressibleError("gives xacro more than a file and arguments")
    return name, text_of((rest, *pieces[1:]))
