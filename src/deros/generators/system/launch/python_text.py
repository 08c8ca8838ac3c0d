"""Substitutions as the Python text of a launch file."""

from __future__ import annotations

from deros.generators.system.computed import Computed, Setting, Text
from deros.generators.system.described import XacroView
from deros.generators.system.files import FileView
from deros.generators.system.launch.declared import VALUE_TYPES
from deros.generators.system.launch.quoting import may_be_misread
from deros.generators.system.launch.substitutions import Substitutions
from deros.generators.system.launch.terms import Term, Terms
from deros.generators.system.literals import python_literal
from deros.generators.system.view import NodeView, SystemView
from deros.models.arguments import Condition, Not
from deros.models.common import Scalar

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
        self.quotes = False
        """Whether the launch file needs the class that puts quotes around texts."""
        self._arguments = {each.name: each for each in view.arguments}

    def text(self, found: Text) -> str:
        """Return a text, or the substitutions that make it."""
        return self._text(self.made.terms(found))

    def path(self, file: FileView) -> str:
        """Return the path of a file."""
        return self._text(self.made.file_path(file))

    def parameter(self, found: Setting, column: int = 0, indent: int = 0) -> str:
        """Return the value of a parameter, with the type that the node declares."""
        is_quoted = may_be_misread(found, self._arguments)
        items = found if isinstance(found, tuple) else (found,)
        computed = [each for each in items if isinstance(each, Computed)]
        if not computed and not is_quoted:
            return python_literal(found, column, indent)  # type: ignore[arg-type]
        kind = VALUE_TYPES[computed[0].type] if computed else "str"
        if isinstance(found, tuple):
            self.used.add("List")
            kind, value = f"List[{kind}]", f"[{', '.join(map(self._item, found))}]"
        else:
            value = self.text(found) if isinstance(found, Computed) else python_literal(found)
        self.used.add("ParameterValue")
        self.quotes |= is_quoted
        return f"{'Text' if is_quoted else 'ParameterValue'}({value}, value_type={kind})"

    def _item(self, found: Scalar | Computed) -> str:
        """Return an element of a list: what is computed of it stands in a list of its own."""
        if not isinstance(found, Computed):
            return python_literal(found)
        terms = self.made.terms(found)
        return f"[{', '.join(map(self.term, terms))}]" if terms else repr("")

    def launch_argument(self, found: Text, column: int, indent: int) -> str:
        """Return the value of an argument of another launch file."""
        if isinstance(found, str):
            return python_literal(found, column, indent)
        return self._text(self.made.launch_argument(found))

    def xacro(self, found: XacroView, indent: int) -> str:
        """Return the value of a parameter that xacro makes."""
        self.used |= {"Command", "ParameterValue"}
        words = (", ".join(map(self.term, word)) for word in self.made.xacro_words(found))
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
            return f"UnlessCondition({self.term(self.made.truth(found.operand))})"
        self.used.add("IfCondition")
        return f"IfCondition({self.term(self.made.truth(found))})"

    def _text(self, terms: Terms) -> str:
        if len(terms) == 1:
            return self.term(terms[0])
        return f"[{', '.join(map(self.term, terms))}]" if terms else repr("")

    def term(self, term: Term) -> str:
        """Return a part of a text."""
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
            text = ", ".join(map(self.term, expression))
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
