"""Substitutions as the Python text of a launch file."""

from __future__ import annotations

from collections.abc import Iterable

from deros.generators.system.computed import Computed, Setting, Text
from deros.generators.system.described import XacroView
from deros.generators.system.expressions import python_value
from deros.generators.system.files import FileView
from deros.generators.system.launch.declared import VALUE_TYPES
from deros.generators.system.launch.substitutions import Substitutions
from deros.generators.system.launch.terms import Term, Terms
from deros.generators.system.literals import python_literal
from deros.generators.system.view import NodeView, SystemView
from deros.models.arguments import Condition, Expression, Not
from deros.models.common import Scalar
from deros.models.node import ParameterType

_KEYWORDS = {
    "EnvironmentVariable": ("", "default_value="),
    "FindExecutable": ("name=",),
    "IfElseSubstitution": ("", "if_value=", "else_value="),
}
"""What stands before the operands of a substitution, where that is more than nothing."""


OWN = frozenset({"Below", "Made", "Plain", "Substituted"})
"""The substitutions that a launch file defines itself."""


class PythonText:
    """Writes substitutions, and remembers which classes they are made of."""

    def __init__(self, view: SystemView) -> None:
        """Write those of one system."""
        self.made = Substitutions(view)
        self.used: set[str] = set()
        """The names to import, of substitutions, conditions and ``ParameterValue``."""

    def text(self, found: Text) -> str:
        """Return a text, or the substitutions that make it."""
        return self._text(self.made.terms(found))

    def path(self, file: FileView) -> str:
        """Return the path of a file."""
        return self._text(self.made.file_path(file))

    def parameter(self, found: Computed | tuple[Scalar | Computed, ...]) -> str:
        """Return the value of a parameter, with the type that the node declares."""
        self.used.add("ParameterValue")
        if isinstance(found, tuple):
            return self._list(found)
        return f"ParameterValue({self.text(found)}, value_type={VALUE_TYPES[found.type]})"

    def launch_argument(self, found: Text, column: int, indent: int) -> str:
        """Return the value of an argument of another launch file."""
        if isinstance(found, str):
            return python_literal(found, column, indent)
        return self._text(self.made.launch_argument(found))

    def xacro(self, found: XacroView, indent: int) -> str:
        """Return the value of a parameter that xacro makes."""
        self.used |= {"Command", "ParameterValue"}
        words = (", ".join(map(self._term, word)) for word in self.made.xacro_words(found))
        pad = " " * indent
        listed = "".join(f"{pad}        {each},\n" for each in words)
        return (
            f"ParameterValue(\n{pad}    Command([\n{listed}{pad}    ], on_stderr='warn'),\n"
            f"{pad}    value_type=str)"
        )

    def yaml(self, found: Setting, column: int, indent: int) -> str:
        """Return the value of a parameter as YAML, for nodes whose parameters are not known."""
        pieces = self.made.yaml_pieces(found)
        if all(isinstance(each, str) for each in pieces):
            return python_literal("".join(map(str, pieces)), column, indent)
        return self.text(Computed(pieces))

    def log_level(self, node: NodeView, column: int, indent: int, after: int) -> str:
        """Return the word that sets the level of a node's own logger."""
        logger = self.made.logger(node.namespace, node.name)
        if len(logger) == 1 and isinstance(logger[0], str):
            return python_literal(f"{logger[0]}:={node.log_level}", column, indent, after)
        return self._text((*logger[:-1], f"{logger[-1]}:={node.log_level}"))

    def condition(self, found: Condition) -> str:
        """Return the condition of an action."""
        if isinstance(found, Not):
            self.used.add("UnlessCondition")
            return f"UnlessCondition({self._term(self.made.truth(found.operand))})"
        self.used.add("IfCondition")
        return f"IfCondition({self._term(self.made.truth(found))})"

    def _list(self, found: tuple[Scalar | Computed, ...]) -> str:
        """Return a list as ``launch_ros`` reads it: YAML, whose texts stand between quotes."""
        kind = next(each.type for each in found if isinstance(each, Computed))
        self.used.add("List")
        if kind is ParameterType.DOUBLE:  # YAML would read a whole number as an integer
            items = (
                python_value(each, self.made.hole) if isinstance(each, Computed) else repr(each)
                for each in found
            )
            listed = self._term(self.made.evaluated(f"[{', '.join(items)}]"))
            return f"ParameterValue({listed}, value_type=List[float])"
        pieces: list[str | Expression] = ["["]
        for position, each in enumerate(found):
            mark = '"' if kind is ParameterType.STRING else ""
            inside: Iterable[str | Expression] = (_yaml(each),)
            if isinstance(each, Computed):
                inside = self.made.in_quotes(each.pieces) if mark else each.pieces
            pieces += [", " * (position > 0) + mark, *inside, mark]
        text = self.text(Computed((*pieces, "]")))
        return f"ParameterValue({text}, value_type=List[{VALUE_TYPES[kind]}])"

    def _text(self, terms: Terms) -> str:
        if len(terms) == 1:
            return self._term(terms[0])
        return f"[{', '.join(map(self._term, terms))}]" if terms else repr("")

    def _term(self, term: Term) -> str:
        if isinstance(term, str):
            return repr(term)
        if term.name in ("Made", "Substituted"):
            path, *given = map(self._text, term.operands)
            pairs = zip(given[::2], given[1::2], strict=True)
            values = ", ".join(f"{name}: {value}" for name, value in pairs)
            return f"{term.name}({path}, {{{values}}})"
        if term.name not in OWN:
            self.used.add(term.name)
        if term.name == "PythonExpression":
            expression, *modules = term.operands
            text = ", ".join(map(self._term, expression))
            used = "".join(f", [{self._text(each)}]" for each in modules)
            return f"{term.name}([{text}]{used})"
        operands = ", ".join(
            keyword + self._text(operand)
            for keyword, operand in zip(
                _KEYWORDS.get(term.name, ("",) * len(term.operands)), term.operands, strict=False
            )
        )
        is_list = term.name == "PathJoinSubstitution"
        return f"{term.name}([{operands}])" if is_list else f"{term.name}({operands})"


def _yaml(value: Scalar | Computed) -> str:
    if isinstance(value, bool):
        return "true" if value else "false"
    if isinstance(value, str):
        return value.replace("\\", "\\\\").replace('"', '\\"')
    return str(value)
