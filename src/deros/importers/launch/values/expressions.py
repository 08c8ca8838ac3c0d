"""What the substitutions of a launch file compute, as expressions and conditions of a system."""

from __future__ import annotations

import posixpath
import re
import shlex
from collections.abc import Callable, Mapping
from dataclasses import dataclass

from deros.importers.launch.values.conditions import (
    NOWHERE,
    all_of,
    any_of,
    compared,
    holds,
    negated,
    text_of,
    truth,
)
from deros.importers.launch.values.python_expressions import PythonReader
from deros.importers.launch.values.substitutions import (
    InexpressibleError,
    Piece,
    Pieces,
    Substitution,
    pieces_of,
)
from deros.models.arguments import (
    Chosen,
    Condition,
    Expression,
    Interpolation,
    Literally,
    Lookup,
)

_TOKEN = re.compile(r"deros__(\d+)__sub")

Values = Mapping[str, Expression | InexpressibleError]
"""Values of launch configurations, or of variables of the environment, that the file has set."""


@dataclass(frozen=True, slots=True)
class Marked:
    """A text in which substitutions are names, and what each of them stands for."""

    text: str
    values: tuple[Expression, ...]

    @staticmethod
    def is_one(text: str) -> bool:
        """Return whether a text is one substitution."""
        return _TOKEN.fullmatch(text) is not None

    def expression(self, text: str) -> Expression:
        """Return what a part of the text, or what was read from it, stands for."""
        found: list[str | Expression] = []
        for number, part in enumerate(_TOKEN.split(text)):
            found.append(self.values[int(part)] if number % 2 else part)
        return text_of(tuple(found))


Unknown = Callable[[str, Expression | None], Expression]


class Expressions:
    """Reads texts of a launch file where some values are known."""

    def __init__(
        self, values: Values, environment: Values, folder: str, file: str, unknown: Unknown
    ) -> None:
        """Read texts.

        Args:
            values: of launch configurations.
            environment: variables that the file has set before.
            folder: of the launch file, from that of the system.
            file: its name.
            unknown: what a configuration with a name and a default is that is not known.
        """
        self._values = values
        self._environment = environment
        self._folder = folder
        self._file = file
        self._unknown = unknown

    def of(self, text: str) -> Expression:
        """Return what a text is.

        Raises:
            InexpressibleError: a model cannot say it.
        """
        return self.joined(pieces_of(text))

    def joined(self, pieces: Pieces) -> Expression:
        """Return what pieces are, one behind the other; as :meth:`of`."""
        return text_of(tuple(map(self._piece, pieces)))

    def marked(self, pieces: Pieces) -> Marked:
        """Return a text that another grammar can read; as :meth:`of`."""
        values: list[Expression] = []
        text = ""
        for piece in pieces:
            if isinstance(piece, str):
                if _TOKEN.search(piece):
                    raise InexpressibleError("has a word that stands for a substitution here")
                text += piece
            else:
                text += f"deros__{len(values)}__sub"
                values.append(self._substitution(piece))
        return Marked(text, tuple(values))

    @staticmethod
    def marked_of(pieces: tuple[str | Expression, ...]) -> Marked:
        """Return pieces that have been read as a text that another grammar can read."""
        values = tuple(each for each in pieces if not isinstance(each, str))
        numbers = iter(range(len(values)))
        words = (e if isinstance(e, str) else f"deros__{next(numbers)}__sub" for e in pieces)
        return Marked("".join(words), values)

    def condition(self, text: str) -> Condition | bool:
        """Return when a text is true, as ``if`` takes it; as :meth:`of`."""
        return holds(self.of(text))

    def path(self, text: str) -> Expression:
        """Return the path of a file, from the folder of the system if it is relative."""
        pieces = pieces_of(text)
        if pieces and _is_folder_unless_absolute(pieces[0]):
            pieces = pieces[1:]  # as a path in a system is
        return self.path_of(self.joined(pieces))

    @staticmethod
    def path_of(found: Expression) -> Expression:
        """Return the path that a text is, from the folder of the system if it is relative."""
        first, *rest = found.pieces if isinstance(found, Interpolation) else (found,)
        if isinstance(first, Lookup) and rest and isinstance(rest[0], str):
            if first.function == "this_dir" and rest[0].startswith("/"):
                inner = rest[0].lstrip("/")
                return text_of((inner if rest[1:] else posixpath.normpath(inner), *rest[1:]))
            if first.function == "share" and rest[0].startswith("/"):
                package = first.name if first.name_from is None else first.name_from
                return text_of(("share:", package, *rest))
        return found

    def _piece(self, piece: Piece) -> str | Expression:
        return piece if isinstance(piece, str) else self._substitution(piece)

    def _substitution(self, found: Substitution) -> Expression:
        reader = _READERS.get(found.name)
        if reader is None:
            raise InexpressibleError(f"needs $({found.name} …), which a model cannot say")
        try:
            return reader(self, *found.operands)
        except TypeError as error:
            message = f"has $({found.name} …) with a number of operands that it does not take"
            raise InexpressibleError(message) from error

    def _name(self, pieces: Pieces) -> str:
        found = self.joined(pieces)
        if not isinstance(found, Literally):
            raise InexpressibleError("has a computed name in a substitution")
        return str(found.value)

    def _var(self, name: Pieces, default: Pieces | None = None) -> Expression:
        key = self._name(name)
        value = self._values.get(key)
        if value is None:
            return self._unknown(key, None if default is None else self.joined(default))
        return _known(value)

    def _env(self, name: Pieces, default: Pieces | None = None) -> Expression:
        key = self._name(name)
        value = self._environment.get(key)
        if value is not None:
            return _known(value)
        if not re.fullmatch(r"[A-Za-z_]\w*", key):
            raise InexpressibleError(f"needs the variable '{key}', which is not a name")
        usual = None if default is None else self._name(default)
        return Lookup("env", key, usual, NOWHERE)

    def _optional_env(self, name: Pieces, default: Pieces = ()) -> Expression:
        return self._env(name, default)

    def _share(self, package: Pieces) -> Expression:
        name = self.joined(package)
        if isinstance(name, Literally):
            return Lookup("share", str(name.value), None, NOWHERE)
        return Lookup("share", "", None, NOWHERE, name_from=name)

    def _prefix(self, package: Pieces) -> Expression:
        return text_of((self._share(package), "/../.."))

    def _program(self, executable: Pieces, package: Pieces) -> Expression:
        parts = (self._prefix(package), "/lib/", self.joined(package), "/")
        return text_of((*parts, self.joined(executable)))

    def _dirname(self) -> Expression:
        here = Lookup("this_dir", self._folder, None, NOWHERE)
        return text_of((here, f"/{self._folder}" if self._folder else ""))

    def _filename(self) -> Expression:
        return text_of((self._dirname(), f"/{self._file}"))

    def _if(self, condition: Pieces, chosen: Pieces = (), otherwise: Pieces = ()) -> Expression:
        found = holds(self.joined(condition))
        if isinstance(found, bool):
            return self.joined(chosen if found else otherwise)
        return Chosen(found, self.joined(chosen), self.joined(otherwise), NOWHERE)

    def _not(self, operand: Pieces) -> Expression:
        return truth(negated(holds(self.joined(operand))))

    def _all(self, *operands: Pieces) -> Expression:
        return truth(all_of(holds(self.joined(each)) for each in operands))

    def _any(self, *operands: Pieces) -> Expression:
        return truth(any_of(holds(self.joined(each)) for each in operands))

    def _equals(self, left: Pieces, right: Pieces) -> Expression:
        return truth(compared("=", self.joined(left), self.joined(right)))

    def _differs(self, left: Pieces, right: Pieces) -> Expression:
        return truth(compared("!=", self.joined(left), self.joined(right)))

    def _eval(self, *operands: Pieces) -> Expression:
        if len(operands) == 2 and all(isinstance(e, str) for e in operands[1]):
            operands = operands[:1]  # the second one are modules
        pieces: list[Piece] = []
        for each in operands:
            pieces += [" ", *each] if pieces else each
        return PythonReader(self.marked(tuple(pieces))).value()

    def words(self, pieces: Pieces) -> list[Expression]:
        """Return the words of a command line; as :meth:`of`."""
        marked = self.marked(pieces)
        try:
            return [marked.expression(word) for word in shlex.split(marked.text)]
        except ValueError as error:
            raise InexpressibleError("has a quote without an end") from error


_READERS: Mapping[str, Callable[..., Expression]] = {
    "all": Expressions._all,
    "and": Expressions._all,
    "any": Expressions._any,
    "dirname": Expressions._dirname,
    "env": Expressions._env,
    "equals": Expressions._equals,
    "eval": Expressions._eval,
    "exec-in-pkg": Expressions._program,
    "exec-in-package": Expressions._program,
    "filename": Expressions._filename,
    "find-pkg-prefix": Expressions._prefix,
    "find-pkg-share": Expressions._share,
    "if": Expressions._if,
    "not": Expressions._not,
    "not-equals": Expressions._differs,
    "optenv": Expressions._optional_env,
    "or": Expressions._any,
    "var": Expressions._var,
}


def _known(value: Expression | InexpressibleError) -> Expression:
    if isinstance(value, InexpressibleError):
        value.is_used = True
        raise value
    return value


def with_programs(pieces: Pieces) -> Pieces:
    """Return a command line in which programs that launch looks up have their plain names."""
    found: list[Piece] = []
    for piece in pieces:
        is_program = isinstance(piece, Substitution) and piece.name == "find-exec"
        inside = piece.operands if isinstance(piece, Substitution) and is_program else ()
        found += inside[0] if len(inside) == 1 else (piece,)
    return tuple(found)


def _is_folder_unless_absolute(piece: Piece) -> bool:
    """Return whether a piece puts a folder before paths that are relative, as deros writes it."""
    if not isinstance(piece, Substitution) or piece.name != "if" or len(piece.operands) != 3:
        return False
    (test, chosen, _) = piece.operands
    if chosen or len(test) != 1 or not isinstance(test[0], Substitution):
        return False
    evaluated = test[0]
    last = evaluated.operands[-1][-1:] if evaluated.operands else ()
    return evaluated.name == "eval" and last == ("'[:1] == '/'",)
