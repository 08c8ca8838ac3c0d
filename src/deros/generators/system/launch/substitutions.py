"""Expressions and conditions in the terms of ``launch``: substitutions, and what they need.

``EqualsSubstitution`` takes texts such as ``1`` and ``true`` for equal, and compares numbers
roughly (``launch.substitutions.equals_substitution``): where a text may look so, ``_`` is put
before both. Numbers are compared by ``PythonExpression``; they come into it as text, which the
launch file has checked before.
"""

from __future__ import annotations

import posixpath
import re
import shlex
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import replace
from pathlib import Path

from deros.generators.system.computed import Computed, Setting
from deros.generators.system.described import XacroView
from deros.generators.system.expressions import (
    python_condition,
    python_expression,
    python_value,
    relative_folder,
)
from deros.generators.system.files import FileView
from deros.generators.system.literals import python_literal
from deros.generators.system.script.standalone.command_line import yaml
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
    Literally,
    Lookup,
    Not,
    OneOf,
    Opposite,
    arguments_in,
    merged,
)
from deros.models.common import Scalar
from deros.models.launch_files import launch_text
from deros.models.node import Parameter, ParameterType

_VALUE_TYPES = {
    ParameterType.BOOL: "bool",
    ParameterType.INTEGER: "int",
    ParameterType.DOUBLE: "float",
    ParameterType.STRING: "str",
}
_LOOKS_OTHERWISE = re.compile(r"[\s+-]*(?:\d|\.\d|inf|nan|true|false)", re.IGNORECASE)
_HOLE = re.compile("\ue000(\\d+)\ue001")


class Substitutions:
    """Writes substitutions, and remembers which classes they are made of."""

    def __init__(
        self,
        arguments: Sequence[Parameter],
        folder: Path,
        made: Iterable[tuple[Lookup, XacroView]] = (),
    ) -> None:
        """Write those of a system with these arguments, whose file is in a folder.

        Args:
            arguments: of the system.
            folder: of its file.
            made: the files that xacro makes, each by a use of its path.
        """
        self._folder = folder
        self._made = dict(made)
        self._holes: list[Argument | Lookup | Chosen] = []
        self._types = {each.name: each.type for each in arguments}
        self._relative = {each.name for each in arguments if _is_relative(each)}
        self.used: set[str] = set()
        """The names to import, of substitutions, conditions and ``ParameterValue``."""
        self.quoted: set[str] = set()
        """The arguments whose values stand between quotes."""

    # Values --------------------------------------------------------------------------------------

    def text(self, found: str | Computed) -> str:
        """Return a text, or the substitutions that make it."""
        if isinstance(found, str):
            return repr(found)
        pieces = [written for each in merged(found.pieces) for written in self._piece(each)]
        if len(pieces) > 1:
            return f"[{', '.join(pieces)}]"
        return pieces[0] if pieces else repr("")

    def _piece(self, piece: str | Expression) -> Iterator[str]:
        if isinstance(piece, str):
            yield repr(piece)
        elif isinstance(piece, Argument):
            yield self._use(piece.name)
        elif isinstance(piece, Lookup):
            yield from self._lookup(piece)
        elif isinstance(piece, Chosen):
            yield self._choice(piece)
        else:
            yield self._python(python_expression(piece, self._hole))

    def path(self, file: FileView) -> str:
        """Return the path of a parameter file."""
        if file.below is None:
            return self._path(file)
        return f"Below({self._path(file)}, {self.text(file.below)})"

    def _path(self, file: FileView) -> str:
        path, folder = file.path, file.folder
        if isinstance(path, str) and posixpath.isabs(path):
            return repr(path)
        if file.package is not None:
            start = self._call("FindPackageShare", repr(file.package))
        else:
            start = self._call("ThisLaunchFileDir")
        pieces = merged(path.pieces) if isinstance(path, Computed) else (path,)
        if isinstance(pieces[0], Lookup) and pieces[0].function != "env":  # an absolute path
            return f"[{', '.join(written for each in pieces for written in self._piece(each))}]"
        if len(pieces) > 1 and (file.package is not None or self._is_relative(pieces[0])):
            between = repr(f"/{folder}/" if folder else "/")
            inside = (written for each in pieces for written in self._piece(each))
            return f"[{', '.join([start, between, *inside])}]"
        parts = [start, *([repr(folder)] if folder else []), self._one_piece(pieces)]
        return self._call("PathJoinSubstitution", f"[{', '.join(parts)}]")

    def _is_relative(self, piece: str | Expression) -> bool:
        """Return whether no absolute path begins with a piece, whatever is given at the start."""
        match piece:
            case Argument(name):
                return name in self._relative
            case Chosen(chosen=chosen, otherwise=otherwise):
                return self._is_relative(chosen) and self._is_relative(otherwise)
            case Literally(value):
                return not str(value).startswith("/")
        return not isinstance(piece, Lookup)

    def _one_piece(self, pieces: tuple[str | Expression, ...]) -> str:
        """Return one substitution for a text."""
        written = [text for each in pieces for text in self._piece(each)]
        if len(written) == 1:
            return written[0]
        for each in pieces:
            self.quoted |= set() if isinstance(each, str) else {a.name for a in arguments_in(each)}
        inside = (
            each.replace("\\", "\\\\").replace("'", "\\'")
            if isinstance(each, str)
            else python_expression(each, self._hole)
            for each in pieces
        )
        return self._python(f"'{''.join(inside)}'")

    def parameter(self, found: Computed | tuple[Scalar | Computed, ...]) -> str:
        """Return the value of a parameter, with the type that the node declares."""
        self.used.add("ParameterValue")
        if isinstance(found, tuple):
            return self._list(found)
        return f"ParameterValue({self.text(found)}, value_type={_VALUE_TYPES[found.type]})"

    def launch_argument(self, found: str | Computed, column: int, indent: int) -> str:
        """Return the value of an argument of another launch file."""
        if isinstance(found, str):
            return python_literal(found, column, indent)
        return self.text(Computed(tuple(self._spelled(found.pieces))))

    def xacro(self, found: XacroView, indent: int) -> str:
        """Return the value of a parameter that xacro makes."""
        self.used |= {"Command", "FindExecutable", "ParameterValue"}
        words = ["FindExecutable(name='xacro'),", self._path_as_word(found.file)]
        words += (self._word(name, value) for name, value in found.arguments)
        pad = " " * indent
        listed = "".join(f"{pad}        {each}\n" for each in words)
        return (
            f"ParameterValue(\n{pad}    Command([\n{listed}{pad}    ], on_stderr='warn'),\n"
            f"{pad}    value_type=str)"
        )

    # ``Command`` takes a text apart as a shell does: what may have blanks stands in quotes.

    def _path_as_word(self, file: FileView) -> str:
        pieces = file.path.pieces if isinstance(file.path, Computed) else (file.path,)
        inside = tuple(self._in_quotes(pieces))
        path = Computed(inside) if isinstance(file.path, Computed) else str(inside[0])
        return f"' \"', {_bare(self.path(replace(file, path=path)))}, '\"',"

    def _word(self, name: str, value: str | Computed) -> str:
        if isinstance(value, str):
            return f"{' ' + shlex.quote(f'{name}:={value}')!r},"
        (first, *others) = value.pieces
        if not others and not isinstance(first, str) and self._is_scalar(first):
            text = _bare(self.launch_argument(value, 0, 0))
            return f"{f' {name}:='!r}, {text},"
        pieces = (f' "{name}:=', *self._in_quotes(value.pieces), '"')
        return f"{_bare(self.text(Computed(pieces)))},"

    def _in_quotes(self, pieces: Iterable[str | Expression]) -> Iterator[str | Expression]:
        for each in merged(pieces):
            if isinstance(each, str):
                yield _escaped(each)
                continue
            self.quoted |= {use.name for use in arguments_in(each)}
            yield _escaped_inside(each)

    def _is_scalar(self, found: Expression) -> bool:
        """Return whether a value is a number or a bool, whose text has no blanks."""
        match found:
            case Argument(name):
                return self._types[name] is not ParameterType.STRING
            case Chosen(chosen=chosen, otherwise=otherwise):
                return self._is_scalar(chosen) and self._is_scalar(otherwise)
            case Literally(value):
                return not isinstance(value, str)
        return isinstance(found, Calculation | Opposite)

    def _spelled(self, pieces: Sequence[str | Expression]) -> Sequence[str | Expression]:
        """Return a value as it is spelled for other launch files, and in YAML."""
        (first, *others) = pieces
        return pieces if others or isinstance(first, str) else [self._as_spelled(first)]

    def _as_spelled(self, found: Expression) -> Expression:
        """Return a value that is spelled as a double if it is one, which 5 may be, too."""
        match found:
            case Chosen(chosen=chosen, otherwise=otherwise):
                both = self._as_spelled(chosen), self._as_spelled(otherwise)
                return replace(found, chosen=both[0], otherwise=both[1])
            case Literally(bool() as value):
                return replace(found, value=launch_text(value))
        if self._is_double(found):
            return Calculation("*", Literally(1.0, found.span), found, found.span)
        return found

    def _is_double(self, found: Expression) -> bool:
        match found:
            case Argument(name):
                return self._types[name] is ParameterType.DOUBLE
            case Literally(value):
                return isinstance(value, float)
            case Opposite(operand):
                return self._is_double(operand)
            case Calculation(operator, left, right):
                return operator == "/" or self._is_double(left) or self._is_double(right)
        return False

    def yaml(self, found: Setting, column: int, indent: int) -> str:
        """Return the value of a parameter as YAML, for nodes whose parameters are not known."""
        if not isinstance(found, tuple):
            return self._yaml_text(self._yaml_pieces(found), column, indent)
        pieces: list[str | Expression] = ["["]
        for position, each in enumerate(found):
            pieces += [", " * (position > 0), *self._yaml_pieces(each)]
        return self._yaml_text([*pieces, "]"], column, indent)

    def _yaml_text(self, pieces: Sequence[str | Expression], column: int, indent: int) -> str:
        joined = merged(pieces)
        if all(isinstance(each, str) for each in joined):
            return python_literal("".join(map(str, joined)), column, indent)
        return self.text(Computed(joined))

    def _yaml_pieces(self, found: Scalar | Computed) -> Sequence[str | Expression]:
        """Return the pieces of a value as YAML: a text between quotes, a double as one."""
        if not isinstance(found, Computed):
            return [yaml(found)]
        (first, *others) = found.pieces
        if others or isinstance(first, str) or self._is_text(first):
            return ['"', *self._in_quotes(found.pieces), '"']
        return self._spelled(found.pieces)

    def _list(self, found: tuple[Scalar | Computed, ...]) -> str:
        """Return a list as ``launch_ros`` reads it: YAML, whose texts stand between quotes."""
        kind = next(each.type for each in found if isinstance(each, Computed))
        self.used.add("List")
        if kind is ParameterType.DOUBLE:  # YAML would read a whole number as an integer
            items = (
                python_value(each, self._hole) if isinstance(each, Computed) else repr(each)
                for each in found
            )
            listed = self._python(f"[{', '.join(items)}]")
            return f"ParameterValue({listed}, value_type=List[float])"
        pieces: list[str | Expression] = ["["]
        for position, each in enumerate(found):
            mark = '"' if kind is ParameterType.STRING else ""
            inside: Iterable[str | Expression] = (_yaml(each),)
            if isinstance(each, Computed):
                inside = self._in_quotes(each.pieces) if mark else each.pieces
            pieces += [", " * (position > 0) + mark, *inside, mark]
        text = self.text(Computed((*pieces, "]")))
        return f"ParameterValue({text}, value_type=List[{_VALUE_TYPES[kind]}])"

    # Conditions ----------------------------------------------------------------------------------

    def condition(self, found: Condition) -> str:
        """Return the condition of an action."""
        if isinstance(found, Not):
            self.used.add("UnlessCondition")
            return f"UnlessCondition({self._truth(found.operand)})"
        self.used.add("IfCondition")
        return f"IfCondition({self._truth(found)})"

    def _truth(self, found: Condition) -> str:
        """Return a substitution that becomes ``true`` or ``false``."""
        match found:
            case Holds(Argument(name)):
                return self._use(name)
            case Holds(Chosen() as operand):
                return self._choice(operand)
            case Not(operand):
                return self._call("NotSubstitution", self._truth(operand))
            case Joined(word, operands):
                name = "AllSubstitution" if word == "and" else "AnySubstitution"
                return self._call(name, *map(self._truth, operands))
            case Compared("=" | "!=" as operator, Argument(name), Literally(bool() as value)):
                same = value == (operator == "=")
                return self._use(name) if same else self._call("NotSubstitution", self._use(name))
            case Compared("=" | "!=" as operator, left, right) if self._is_plain(left):
                call = "EqualsSubstitution" if operator == "=" else "NotEqualsSubstitution"
                return self._call(call, *self._alike(left, right))
            case OneOf(operand, choices) if self._is_plain(operand):
                each = [Compared("=", operand, choice, found.span) for choice in choices]
                if len(each) == 1:
                    return self._truth(each[0])
                return self._call("AnySubstitution", *map(self._truth, each))
        return self._python(python_condition(found, self._hole))

    def _is_plain(self, operand: Expression) -> bool:
        """Return whether an operand is a text or a bool, and no number."""
        if isinstance(operand, Argument):
            return self._types[operand.name] in (ParameterType.STRING, ParameterType.BOOL)
        if isinstance(operand, Literally):
            return isinstance(operand.value, str | bool)
        if isinstance(operand, Chosen):
            return self._is_plain(operand.chosen)
        return isinstance(operand, Interpolation | Lookup)

    def _alike(self, *operands: Expression) -> Iterator[str]:
        """Return operands that are compared as texts, even where one looks like a number."""
        found = [merged((each,)) for each in operands]
        is_text = any(map(self._is_text, operands))
        is_clear = any(
            _LOOKS_OTHERWISE.match("".join(map(str, pieces))) is None
            for operand, pieces in zip(operands, found, strict=True)
            if isinstance(operand, Literally)
        )
        mark = "_" * (is_text and not is_clear)
        return (self.text(Computed(merged((mark, *pieces)))) for pieces in found)

    def _is_text(self, operand: Expression) -> bool:
        if isinstance(operand, Chosen):
            return self._is_text(operand.chosen)
        if isinstance(operand, Argument):
            return self._types[operand.name] is ParameterType.STRING
        is_text = isinstance(operand, Literally) and isinstance(operand.value, str)
        return is_text or isinstance(operand, Interpolation | Lookup)

    # Pieces --------------------------------------------------------------------------------------

    def _use(self, name: str) -> str:
        self.used.add("LaunchConfiguration")
        return f"LaunchConfiguration({name!r})"

    def _lookup(self, found: Lookup) -> Iterator[str]:
        if found.made is not None:
            view = self._made[found]
            given = (f"{n!r}: {self.launch_argument(v, 0, 0)}" for n, v in view.arguments)
            yield f"Made({self.path(view.file)}, {{{', '.join(given)}}})"
        elif found.function == "share":
            yield self._call("FindPackageShare", repr(found.name))
        elif found.function == "this_dir":
            yield self._call("ThisLaunchFileDir")
            folder = relative_folder(found, self._folder)
            yield from () if folder is None else (repr(f"/{folder}"),)
        else:
            default = [] if found.default is None else [f"default_value={found.default!r}"]
            yield self._call("EnvironmentVariable", repr(found.name), *default)

    def _choice(self, found: Chosen) -> str:
        both = (self.text(Computed((each,))) for each in (found.chosen, found.otherwise))
        chosen, otherwise = (
            f"{n}={t}" for n, t in zip(("if_value", "else_value"), both, strict=True)
        )
        return self._call("IfElseSubstitution", self._truth(found.condition), chosen, otherwise)

    def _call(self, name: str, *arguments: str) -> str:
        self.used.add(name)
        return f"{name}({', '.join(arguments)})"

    def _hole(self, found: Argument | Lookup | Chosen) -> str:
        """Return what stands for a substitution in the text of a Python expression."""
        if found not in self._holes:
            self._holes.append(found)
        return f"\ue000{self._holes.index(found)}\ue001"

    def _python(self, text: str) -> str:
        pieces = _HOLE.split(text)
        parts = [
            written
            for position, each in enumerate(pieces)
            if each
            for written in (self._piece(self._holes[int(each)]) if position % 2 else [repr(each)])
        ]
        return self._call("PythonExpression", f"[{', '.join(parts)}]")


def _is_relative(argument: Parameter) -> bool:
    if argument.type is not ParameterType.STRING:
        return True
    choices = argument.choices or ()
    return bool(choices) and not any(str(each).startswith("/") for each in choices)


def _yaml(value: Scalar | Computed) -> str:
    if isinstance(value, bool):
        return "true" if value else "false"
    if isinstance(value, str):
        return value.replace("\\", "\\\\").replace('"', '\\"')
    return str(value)


def _bare(text: str) -> str:
    """Return the elements of a list without its brackets, and all else as it is."""
    return text[1:-1] if text.startswith("[") else text


def _escaped(text: str) -> str:
    """Return a text as it stands between double quotes of a shell."""
    return text.replace("\\", "\\\\").replace('"', '\\"')


def _escaped_inside(found: Expression) -> Expression:
    """Return an expression whose texts are to stand between double quotes."""
    match found:
        case Literally(str() as value):
            return replace(found, value=_escaped(value))
        case Interpolation(pieces):
            inside = (_escaped(p) if isinstance(p, str) else _escaped_inside(p) for p in pieces)
            return replace(found, pieces=tuple(inside))
        case Chosen(chosen=chosen, otherwise=otherwise):
            both = _escaped_inside(chosen), _escaped_inside(otherwise)
            return replace(found, chosen=both[0], otherwise=both[1])
    return found
