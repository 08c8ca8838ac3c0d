"""Expressions and conditions in the terms of ``launch``: the substitutions that they become.

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

from deros.generators.system.computed import Computed, Setting, Text
from deros.generators.system.described import XacroView
from deros.generators.system.expressions import (
    python_condition,
    python_expression,
    relative_folder,
)
from deros.generators.system.files import FileView
from deros.generators.system.launch.terms import Substitution, Term, Terms, joined
from deros.generators.system.script.standalone.command_line import yaml
from deros.generators.system.view import SystemView
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
    launch_text,
    merged,
)
from deros.models.common import Scalar
from deros.models.node import Parameter, ParameterType

_PACKAGES = "ament_index_python"
_LOOKS_OTHERWISE = re.compile(r"[\s+-]*(?:\d|\.\d|inf|nan|true|false)", re.IGNORECASE)
_HOLE = re.compile("\ue000(\\d+)\ue001")


class Substitutions:
    """Makes substitutions of what a system computes when it is started."""

    def __init__(self, view: SystemView) -> None:
        """Make those of one system."""
        self._folder = view.folder
        self._made = dict(view.made)
        self._holes: list[Argument | Lookup | Chosen] = []
        self._types = {each.name: each.type for each in view.arguments}
        self._relative = {each.name for each in view.arguments if _is_relative(each)}
        self.quoted: set[str] = set()
        """The arguments whose values stand between quotes."""

    # Values --------------------------------------------------------------------------------------

    def terms(self, found: Text) -> Terms:
        """Return what a text is made of."""
        if isinstance(found, str):
            return (found,)
        return self._terms(merged(found.pieces))

    def _terms(self, pieces: Iterable[str | Expression]) -> Terms:
        return tuple(term for each in pieces for term in self._piece(each))

    def _piece(self, piece: str | Expression) -> Iterator[Term]:
        if isinstance(piece, str):
            yield piece
        elif isinstance(piece, Argument):
            yield _call("LaunchConfiguration", (piece.name,))
        elif isinstance(piece, Lookup):
            yield from self._lookup(piece)
        elif isinstance(piece, Chosen):
            yield self._choice(piece)
        else:
            yield self.evaluated(python_expression(piece, self.hole))

    def file_path(self, file: FileView) -> Terms:
        """Return the path of a file that the system names."""
        found = self._file_path(file)
        if file.given is not None:
            operands = (p for n, v in file.given for p in ((n,), self.launch_argument(v)))
            found = (_call("Substituted", found, *operands),)
        if file.plain is not None:
            return (_call("Plain", found, *([(file.plain,)] if file.plain else [])),)
        return found if file.below is None else (_call("Below", found, self.terms(file.below)),)

    def _file_path(self, file: FileView) -> Terms:
        path, folder = file.path, file.folder
        if isinstance(path, str) and posixpath.isabs(path):
            return (path,)
        start = _call("ThisLaunchFileDir")
        if file.package is not None:
            start = _call("FindPackageShare", self.terms(file.package))
        pieces = merged(path.pieces) if isinstance(path, Computed) else (path,)
        if isinstance(pieces[0], Lookup) and pieces[0].function != "env":  # an absolute path
            return self._terms(pieces)
        if len(pieces) > 1 and (file.package is not None or self._is_relative(pieces[0])):
            return (start, f"/{folder}/" if folder else "/", *self._terms(pieces))
        return self._joined(start, folder, pieces)

    def _joined(self, start: Term, folder: str, pieces: tuple[str | Expression, ...]) -> Terms:
        """Return a path that starts in a folder, unless what follows is an absolute one."""
        parts = [start, *([folder] if folder else []), self._one_piece(pieces)]
        return (_call("PathJoinSubstitution", *((part,) for part in parts)),)

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

    def _one_piece(self, pieces: tuple[str | Expression, ...]) -> Term:
        """Return one term for a text."""
        written = self._terms(pieces)
        return written[0] if len(written) == 1 else self.evaluated(self._literal(pieces))

    def _literal(self, pieces: tuple[str | Expression, ...]) -> str:
        """Return a text as a literal of Python."""
        for each in pieces:
            self.quoted |= set() if isinstance(each, str) else {a.name for a in arguments_in(each)}
        inside = (
            each.replace("\\", "\\\\").replace("'", "\\'")
            if isinstance(each, str)
            else python_expression(each, self.hole)
            for each in pieces
        )
        return f"'{''.join(inside)}'"

    def logger(self, namespace: Text, name: str) -> Terms:
        """Return the name of a node's own logger, as rcl makes it from the full name."""
        pieces = (namespace,) if isinstance(namespace, str) else merged(namespace.pieces)
        terms: list[Term] = []
        for each in pieces:
            if isinstance(each, str):
                terms.append(each.replace("/", "."))
                continue
            inside = python_expression(each, self.hole)
            terms.append(self.evaluated(f"'{inside}'.replace('/', '.')"))
        first, *others = joined((*terms, f".{name}"))
        return (first.removeprefix(".") if isinstance(first, str) else first, *others)

    def launch_argument(self, found: Text) -> Terms:
        """Return the value of an argument of another launch file."""
        if isinstance(found, str):
            return (found,)
        return self.terms(Computed(tuple(self._spelled(found.pieces))))

    def xacro_words(self, found: XacroView) -> Iterator[Terms]:
        """Yield the words of the command that makes the value of a parameter, with blanks before.

        ``Command`` takes a text apart as a shell does: what may have blanks stands in quotes.
        """
        yield (_call("FindExecutable", ("xacro",)),)
        yield self._path_as_word(found.file)
        for name, value in found.arguments:
            yield self._word(name, value)

    def _path_as_word(self, file: FileView) -> Terms:
        pieces = file.path.pieces if isinstance(file.path, Computed) else (file.path,)
        inside = tuple(self.in_quotes(pieces))
        path = Computed(inside) if isinstance(file.path, Computed) else str(inside[0])
        return (' "', *self.file_path(replace(file, path=path)), '"')

    def _word(self, name: str, value: Text) -> Terms:
        if isinstance(value, str):
            return (" " + shlex.quote(f"{name}:={value}"),)
        (first, *others) = value.pieces
        if not others and not isinstance(first, str) and self._is_scalar(first):
            return (f" {name}:=", *self.launch_argument(value))
        pieces = (f' "{name}:=', *self.in_quotes(value.pieces), '"')
        return self.terms(Computed(pieces))

    def in_quotes(self, pieces: Iterable[str | Expression]) -> Iterator[str | Expression]:
        """Yield pieces as they stand between double quotes; arguments in them have no quotes."""
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

    def yaml_pieces(self, found: Setting) -> tuple[str | Expression, ...]:
        """Return the value of a parameter as YAML, for nodes whose parameters are not known."""
        if not isinstance(found, tuple):
            return merged(self._yaml_pieces(found))
        pieces: list[str | Expression] = ["["]
        for position, each in enumerate(found):
            pieces += [", " * (position > 0), *self._yaml_pieces(each)]
        return merged([*pieces, "]"])

    def _yaml_pieces(self, found: Scalar | Computed) -> Sequence[str | Expression]:
        """Return the pieces of a value as YAML: a text between quotes, a double as one."""
        if not isinstance(found, Computed):
            return [yaml(found)]
        (first, *others) = found.pieces
        if others or isinstance(first, str) or self._is_text(first):
            return ['"', *self.in_quotes(found.pieces), '"']
        return self._spelled(found.pieces)

    # Conditions ----------------------------------------------------------------------------------

    def truth(self, found: Condition) -> Term:
        """Return a substitution that becomes ``true`` or ``false``."""
        match found:
            case Holds(Argument(name)):
                return _call("LaunchConfiguration", (name,))
            case Holds(Chosen() as operand):
                return self._choice(operand)
            case Not(operand):
                return _call("NotSubstitution", (self.truth(operand),))
            case Joined(word, operands):
                name = "AllSubstitution" if word == "and" else "AnySubstitution"
                return _call(name, *((self.truth(each),) for each in operands))
            case Compared("=" | "!=" as operator, Argument(name), Literally(bool() as value)):
                holds = _call("LaunchConfiguration", (name,))
                same = value == (operator == "=")
                return holds if same else _call("NotSubstitution", (holds,))
            case Compared("=" | "!=" as operator, left, right) if self._is_plain(left):
                name = "EqualsSubstitution" if operator == "=" else "NotEqualsSubstitution"
                return _call(name, *self._alike(left, right))
            case OneOf(operand, choices) if self._is_plain(operand):
                each = [Compared("=", operand, choice, found.span) for choice in choices]
                if len(each) == 1:
                    return self.truth(each[0])
                return _call("AnySubstitution", *((self.truth(one),) for one in each))
        return self.evaluated(python_condition(found, self.hole))

    def _is_plain(self, operand: Expression) -> bool:
        """Return whether an operand is a text or a bool, and no number."""
        if isinstance(operand, Argument):
            return self._types[operand.name] in (ParameterType.STRING, ParameterType.BOOL)
        if isinstance(operand, Literally):
            return isinstance(operand.value, str | bool)
        if isinstance(operand, Chosen):
            return self._is_plain(operand.chosen)
        return isinstance(operand, Interpolation | Lookup)

    def _alike(self, *operands: Expression) -> Iterator[Terms]:
        """Return operands that are compared as texts, even where one looks like a number."""
        found = [merged((each,)) for each in operands]
        is_text = any(map(self._is_text, operands))
        is_clear = any(
            _LOOKS_OTHERWISE.match("".join(map(str, pieces))) is None
            for operand, pieces in zip(operands, found, strict=True)
            if isinstance(operand, Literally)
        )
        mark = "_" * (is_text and not is_clear)
        return (self._terms(merged((mark, *pieces))) for pieces in found)

    def _is_text(self, operand: Expression) -> bool:
        if isinstance(operand, Chosen):
            return self._is_text(operand.chosen)
        if isinstance(operand, Argument):
            return self._types[operand.name] is ParameterType.STRING
        is_text = isinstance(operand, Literally) and isinstance(operand.value, str)
        return is_text or isinstance(operand, Interpolation | Lookup)

    # Pieces --------------------------------------------------------------------------------------

    def _lookup(self, found: Lookup) -> Iterator[Term]:
        if found.made is not None:
            view = self._made[found]
            given = ((n, self.launch_argument(v)) for n, v in view.arguments)
            operands = (part for name, value in given for part in ((name,), value))
            yield _call("Made", self.file_path(view.file), *operands)
        elif found.function == "share":
            name = (found.name,)
            package = name if found.name_from is None else self._terms(merged((found.name_from,)))
            yield _call("FindPackageShare", package)
        elif found.function == "this_dir":
            yield _call("ThisLaunchFileDir")
            folder = relative_folder(found, self._folder)
            yield from () if folder is None else (f"/{folder}",)
        elif found.function == "installed":
            is_there = f"{found.name!r} in {_PACKAGES}.get_packages_with_prefixes()"
            yield _call("PythonExpression", (f"str({is_there}).lower()",), (_PACKAGES,))
        else:
            default: list[Terms] = [] if found.default is None else [(found.default,)]
            yield _call("EnvironmentVariable", (found.name,), *default)

    def _choice(self, found: Chosen) -> Term:
        both = (self.terms(Computed((each,))) for each in (found.chosen, found.otherwise))
        return _call("IfElseSubstitution", (self.truth(found.condition),), *both)

    def hole(self, found: Argument | Lookup | Chosen) -> str:
        """Return what stands for a substitution in the text of a Python expression."""
        if found not in self._holes:
            self._holes.append(found)
        return f"\ue000{self._holes.index(found)}\ue001"

    def evaluated(self, text: str) -> Term:
        """Return what evaluates the text of a Python expression, whose holes are filled."""
        parts = [
            term
            for position, each in enumerate(_HOLE.split(text))
            if each
            for term in (self._piece(self._holes[int(each)]) if position % 2 else (each,))
        ]
        return _call("PythonExpression", tuple(parts))


def _call(name: str, *operands: Terms) -> Substitution:
    return Substitution(name, operands)


def _is_relative(argument: Parameter) -> bool:
    if argument.type is not ParameterType.STRING:
        return True
    choices = argument.choices or ()
    return bool(choices) and not any(str(each).startswith("/") for each in choices)


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
