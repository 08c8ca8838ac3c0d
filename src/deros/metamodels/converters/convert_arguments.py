"""Arguments of systems, and the expressions and conditions that use them."""

from __future__ import annotations

import re
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from typing import Any, Literal, cast

from deros import codes
from deros.diagnostics import SourceFile, Span
from deros.metamodels.converters.convert_parameters import ParameterConverter
from deros.metamodels.matching import Token
from deros.metamodels.reading import MAX_DEPTH, too_deep
from deros.models.arguments import (
    Argument,
    Calculation,
    Chosen,
    Compared,
    Condition,
    Expression,
    Holds,
    Interpolation,
    Joined,
    LaunchArgument,
    Literally,
    Lookup,
    Not,
    OneOf,
    Opposite,
    Passed,
    launch_text,
)
from deros.models.common import Value
from deros.models.launch_files import MadeFile
from deros.models.node import Parameter
from deros.models.terms import ArithmeticOperator, ComparisonOperator
from deros.names.names import check_package_name

_USE = re.compile(r"\$\$(?=\{)|\$\{(?P<name>[^}]*)(?P<end>\}?)")
"""The value of an argument in a text; ``$${`` stands for ``${`` itself."""

_LOOKUP = re.compile(
    r"(?P<function>env|share)\((?P<name>[^(),]*)(?:,(?P<default>[^(),]*))?\)\Z|this_dir\Z"
)
"""What is looked up, in a text, where nothing needs quotes: ``${env(ROBOT, courier)}``."""

_NAME = re.compile(r"[A-Za-z_]\w*\Z", re.ASCII)


_UNFIT = {
    "a launch file": codes.UNFIT_LAUNCH_ARGUMENT,
    "a parameter file": codes.SUBSTITUTION_IN_FILE,
    "xacro": codes.UNFIT_XACRO,
}
"""What is reported of an argument that is no text, by who reads it."""


class ArgumentConverter(ParameterConverter):
    """Converts what a system computes; ``is_computed`` once there was any of that."""

    is_computed = False
    _is_default = False
    _operations = 0
    """Of the present value or condition."""

    def __init__(self, source: SourceFile) -> None:
        """Start with a file whose made files are not known."""
        super().__init__(source)
        self.made_files: dict[str, MadeFile] = {}
        self.made_files_at: dict[int, MadeFile] = {}

    def computed_name(self, token: Token) -> tuple[str, Expression | None]:
        """Return a graph name as written, and what it is computed from, if it is."""
        if token[0] not in '$"':
            return str(token), None
        found = self._use(token) if token[0] == "$" else self._text(token)
        if isinstance(found, Literally):
            return str(found.value), None
        return str(token).strip('"'), found

    def only_if(self, found: Any) -> Condition | None:
        """Return the condition of a word that counts only where it holds, if it has one."""
        return None if found.only is None else self.condition(found.only.condition)

    def computed_value(
        self, found: Any
    ) -> tuple[Value, Expression | tuple[Expression, ...] | None]:
        """Return the value of a ``param``, and what it is computed from, if it is."""
        if found.scalar is not None or found.array is not None:
            items = [found.scalar] if found.array is None else [e.item for e in found.array.items]
            values = tuple(
                self._use(each) if each[0] == "$" else self._text(each) for each in items
            )
            plain = tuple(each.value for each in values if isinstance(each, Literally))
            is_varied = found.array is not None and any(e.when for e in found.array.items)
            if len(plain) < len(values) or is_varied:
                return "", values if found.array is not None else values[0]
            return (plain if found.array is not None else plain[0]), None
        expression = self.expression(found.value)
        if isinstance(expression, Literally):
            return expression.value, None
        self.is_computed = True
        return "", expression

    def element_conditions(self, found: Any) -> tuple[Condition | None, ...]:
        """Return the conditions of the elements of a list, if one has a condition."""
        whens = () if found.array is None else tuple(each.when for each in found.array.items)
        if not any(whens):
            return ()
        return tuple(each and self.condition(each.condition) for each in whens)

    def setting_span(self, found: Any) -> Span:
        """Return the place of the value of a ``param``."""
        if found.scalar is not None:
            return self.token_span(found.scalar)
        return self.span(found.array if found.array is not None else found.value)

    def passed(self, found: Any) -> Passed:
        """Return the value that is passed to an argument."""
        self.is_computed = True
        return Passed(self.name(found.name), self.expression(found.value), self.span(found))

    # Expressions ---------------------------------------------------------------------------------

    def expression(self, found: Any) -> Expression:
        """Return an expression that is not part of another."""
        self._operations = 0
        return self._expression(found)

    def _expression(self, found: Any) -> Expression:
        if found.condition is not None:
            chosen, otherwise = map(self._expression, (found.chosen, found.otherwise))
            return Chosen(self._condition(found.condition), chosen, otherwise, self.span(found))
        return self._chain(found, self._product)

    def _product(self, found: Any) -> Expression:
        return self._chain(found, self._factor)

    def _chain(self, found: Any, operand: Callable[[Any], Expression]) -> Expression:
        """Return what operators of one kind make of their operands, from left to right."""
        result = operand(found.first)
        if not self._is_too_deep(found, len(found.rest)):
            for each in found.rest:
                result = self._calculation(result, each.operator, operand(each.operand))
        return result

    def _is_too_deep(self, found: Any, operations: int) -> bool:
        """Count operations of one value; report once if they are more than anybody can follow."""
        before = self._operations
        self._operations += operations
        if before <= MAX_DEPTH < self._operations:
            self.diagnostics.append(too_deep(self.span(found)))
            self.lose(self.span(found))
        return self._operations > MAX_DEPTH

    def _calculation(self, left: Expression, operator: Token, right: Expression) -> Expression:
        span = Span(self.source, left.span.start, right.span.end)
        return Calculation(cast(ArithmeticOperator, str(operator)), left, right, span)

    def _factor(self, found: Any) -> Expression:
        if found.scalar is not None:
            return self._text(found.scalar)
        if found.argument is not None:
            return self._use(found.argument)
        if found.lookup is not None:
            return self._lookup(found.lookup)
        if found.opposite is not None:
            operand = self._factor(found.opposite.operand)
            if self._is_too_deep(found, 1):
                return operand
            return Opposite(operand, self.span(found))
        return self._expression(found.inner)

    def _lookup(self, found: Any) -> Expression:
        if found.function == "share" and found.default is None and found.name is not None:
            package = self._text(found.name)
            if not isinstance(package, Literally):
                self.is_computed = True
                span = self.span(found)
                return Lookup("share", str(found.name).strip('"'), None, span, name_from=package)
        name = None if found.name is None else self.text(found.name)
        default = None if found.default is None else self.text(found.default)
        return self._looked_up(str(found.function), name, default, self.span(found))

    def _looked_up(
        self, function: str, name: str | None, default: str | None, span: Span
    ) -> Expression:
        self.is_computed = True
        fault = None
        if function == "this_dir":
            fault = None if name is None else "'this_dir' is a folder, and takes no name"
            name = Path(self.source.path).absolute().parent.as_posix()
        elif function == "installed" and not self._is_default:
            fault = "only the default of an argument may say whether a package is installed"
        elif function in ("share", "installed") and default is not None:
            fault = "whether and where a package is installed has no default"
        elif function in ("share", "installed") and check_package_name(name or "") is not None:
            fault = f"'{name}' is not the name of a package"
        elif function == "env" and not _NAME.match(name or ""):
            fault = f"'{name}' is not the name of a variable"
        if fault is not None:
            hint = "write 'env(\"NAME\", \"default\")', 'share(\"package\")' or 'this_dir'"
            if function == "installed":
                hint = "write 'argument has_it : bool = installed(\"package\")', and use 'has_it'"
            self.report(codes.SYNTAX_ERROR, fault, span, hint)
            self.lose(span)
            function = "env"  # a text, as is nearly always meant
        kind = cast(Literal["env", "share", "this_dir", "installed"], function)
        return Lookup(kind, name or "", default, span)

    def argument(self, found: Any) -> Parameter | None:
        """Return a declared argument; ``None`` where its type is unknown, which is reported."""
        declared = self.parameter(found)
        if declared is None:
            return None
        computed: Expression | None = None
        if found.computed is not None:
            self._is_default = True
            computed = self.expression(found.computed)
            self._is_default = False
        elif isinstance(declared.default, str):
            computed = self._text(found.default)
        if computed is None or (isinstance(computed, Literally) and found.computed is None):
            return declared
        return replace(declared, default=None, default_span=computed.span, default_from=computed)

    def _use(self, token: Token) -> Argument | Lookup | Chosen:
        return self._used(str(token).removeprefix("$"), self.token_span(token))

    def _used(self, name: str, span: Span) -> Argument | Lookup | Chosen:
        """Return the value of an argument, or the path of a file that is made."""
        self.is_computed = True
        made = self.made_files.get(name)
        if made is None:
            return Argument(name, span)
        path = Lookup("made", name, None, span, made.xacro)
        return path if made.when is None else Chosen(made.when, path, Literally("", span), span)

    def _text(self, token: Token) -> Literally | Interpolation:
        """Return a scalar; a text with the values of arguments in it, if it is one."""
        span = self.token_span(token)
        if token[0] != '"' or "${" not in token:
            return Literally(self.scalar(token), span)
        pieces: list[str | Expression] = []
        written = str(token)[1:-1]
        after = 0
        for use in _USE.finditer(written):
            pieces.append(written[after : use.start()])
            after = use.end()
            start = span.start + 1 + use.start()
            place = Span(self.source, start, start + len(use[0]))
            if use["name"] is None:
                pieces.append("$")
            elif use["end"] and (looked := _LOOKUP.match(use["name"])):
                name, default = (each and each.strip() for each in looked.group("name", "default"))
                default = default and self._unescaped(default, token)
                pieces.append(
                    self._looked_up(looked["function"] or "this_dir", name, default, place)
                )
            elif use["end"] and _NAME.match(use["name"]):
                pieces.append(self._used(use["name"], place))
            else:
                message = f"'{use[0]}' is not the value of an argument"
                hint = (
                    "write '${NAME}' with the name of an argument, '${env(NAME)}',"
                    " '${share(PACKAGE)}' or '${this_dir}'; '$${' stands for '${' itself"
                )
                self.report(codes.SYNTAX_ERROR, message, place, hint)
                # Some text that may stand in a name, so that no other finding follows.
                self.lose(place)
                pieces.append("".join(re.findall(r"\w", use[0], re.ASCII)))
        pieces.append(written[after:])
        joined = tuple(
            self._unescaped(each, token) if isinstance(each, str) else each for each in pieces
        )
        if all(isinstance(each, str) for each in joined):
            return Literally("".join(map(str, joined)), span)
        self.is_computed = True
        return Interpolation(joined, span)

    def _unescaped(self, piece: str, token: Token) -> str:
        quoted = Token(f'"{piece}"')
        quoted.start = token.start
        return self.text(quoted)

    def launch_argument(self, found: Any, reader: str = "a launch file") -> LaunchArgument:
        """Return an argument as the text that its reader gets."""
        value, value_from = "", None
        if found.array is not None:
            span = self.span(found.array)
            who = reader.replace("a ", "the ")
            hint = f"write the text that {who} reads: '{found.name} = \"…\"'"
            message = f"{reader} gets texts, and this is a list"
            self.report(_UNFIT[reader], message, span, hint)
        else:
            written: Expression = self.expression(found.value)
            span = written.span
            value_from = None if isinstance(written, Literally) else written
            value = launch_text(written.value) if isinstance(written, Literally) else span.text
        return LaunchArgument(
            self.written(found.name),
            value,
            self.span(found),
            self.token_span(found.name),
            span,
            value_from,
        )

    # Conditions ----------------------------------------------------------------------------------

    def condition(self, found: Any) -> Condition:
        """Return the condition after ``when``."""
        self._operations = 0
        return self._condition(found)

    def _condition(self, found: Any) -> Condition:
        self.is_computed = True
        return self._joined("or", found, self._conjunction)

    def _conjunction(self, found: Any) -> Condition:
        return self._joined("and", found, self._part)

    def _joined(self, word: Literal["and", "or"], found: Any, part: Any) -> Condition:
        operands: tuple[Condition, ...] = tuple(map(part, found.operands))
        return operands[0] if len(operands) == 1 else Joined(word, operands, self.span(found))

    def _part(self, found: Any) -> Condition:
        if found.negated is not None:
            negated = self._part(found.negated)
            return negated if self._is_too_deep(found, 1) else Not(negated, self.span(found))
        if found.inner is not None:
            return self._condition(found.inner)
        return self._comparison(found.comparison)

    def _comparison(self, found: Any) -> Condition:
        left, span = self._operand(found.left), self.span(found)
        if found.choices is not None:
            items = found.choices.items
            choices = tuple(Literally(self.scalar(each), self.token_span(each)) for each in items)
            return OneOf(left, choices, span)
        if found.operator is None:
            return Holds(left, span)
        operator = cast(ComparisonOperator, str(found.operator))
        return Compared(operator, left, self._operand(found.right), span)

    def _operand(self, found: Any) -> Expression:
        if found.scalar is not None:
            return Literally(self.scalar(found.scalar), self.token_span(found.scalar))
        return self._use(found.argument)
