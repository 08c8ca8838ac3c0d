"""The texts of a system, its values and conditions, as attributes of the frontends have them."""

from __future__ import annotations

import shlex
from collections.abc import Callable, Iterable

from deros.generators.system.computed import Computed, Setting, Text
from deros.generators.system.described import XacroView
from deros.generators.system.files import FileView
from deros.generators.system.frontends.elements import Element, ReadAsYaml, Value, element
from deros.generators.system.frontends.grammar import template, without_controls
from deros.generators.system.launch.declared import VALUE_TYPES
from deros.generators.system.launch.substitutions import Substitutions
from deros.generators.system.launch.terms import Substitution, Term, Terms, joined
from deros.generators.system.view import NodeView, SystemView
from deros.models.arguments import Condition, Expression, Not
from deros.models.common import Scalar

Attributes = tuple[tuple[str, Value], ...]


class Texts:
    """Writes what is known or computed of a system."""

    def __init__(self, view: SystemView) -> None:
        """Write what one system consists of."""
        self.made = _Substitutions(view)
        self._stem = view.stem
        self._folder = f"{view.stem}.dirname" if any(view.launches) else None
        self._uses_folder = False
        self._hidden: dict[str, Term] | None = None  # the values of names that stand for others

    @property
    def folder(self) -> tuple[Element, ...]:
        """What remembers the folder of this file, which launch forgets when it includes another.

        It is needed if what has been written so far uses the folder.
        """
        if self._folder is None or not self._uses_folder:
            return ()
        here = template((Substitution("ThisLaunchFileDir"),))
        return (element("let", name=template((self._folder,)), value=here),)

    def hidden(self, make: Callable[[], Iterable[Element]]) -> tuple[Element, ...]:
        """Return actions for which the arguments of the system have other names.

        What these include sees none of them. Before the actions stands one that gives them these
        names, and keeps no other value but the namespace.
        """
        self._hidden = {}
        inside = tuple(make())
        kept: dict[str, Term] = {"ros_namespace": _value_of("ros_namespace", ""), **self._hidden}
        self._hidden = None
        details = (element("keep", name=n, value=template((value,))) for n, value in kept.items())
        return (element("reset", *details), *inside)

    def text(self, found: Text) -> str:
        """Return a text."""
        return self.template(self.made.terms(found))

    def path(self, file: FileView) -> str:
        """Return the path of a file."""
        return self.template(self.made.file_path(file))

    def content(self, file: FileView) -> str:
        """Return what reads a file, and fails without it."""
        return self.template((Substitution("FileContent", (self.made.file_path(file),)),))

    def launch_argument(self, found: Text) -> str:
        """Return the value of an argument of another launch file."""
        return self.template(self.made.launch_argument(found))

    def condition(self, found: Condition | None) -> Attributes:
        """Return the attribute that says when an action is executed."""
        if found is None:
            return ()
        if isinstance(found, Not):
            return (("unless", self.template((self.made.truth(found.operand),))),)
        return (("if", self.template((self.made.truth(found),))),)

    def words(self, found: Iterable[Text]) -> str | None:
        """Return the words of a command line, which launch takes apart as a shell does."""
        terms: list[Term] = []
        for word in found:
            terms += [" "] * bool(terms)
            made = list(without_controls(self.made.terms(word)))
            terms += (e if isinstance(e, Substitution) else shlex.quote(e) for e in made or [""])
        return self.template(joined(terms)) if terms else None

    def log_level(self, node: NodeView) -> str:
        """Return the words that set the level of a node's own logger."""
        logger = self.made.logger(node.namespace, node.name)
        return self.template(joined(("--log-level ", *logger, f":={node.log_level}")))

    def parameter(self, name: str, found: Setting) -> Element:
        """Return an element that sets a parameter, with the type that the node declares."""
        if isinstance(found, tuple):
            return self._list(name, found)
        value: Value
        if not isinstance(found, Computed):
            kind = _type_of(found)
            value = template((found,)) if isinstance(found, str) else found
        else:
            kind, text = VALUE_TYPES[found.type], self.text(found)
            value = ReadAsYaml(text) if kind == "bool" else text
        return _param(name, value, kind)

    def _list(self, name: str, found: tuple[Scalar | Computed, ...]) -> Element:
        kinds = {VALUE_TYPES[e.type] if isinstance(e, Computed) else _type_of(e) for e in found}
        kind = "float" if kinds == {"int", "float"} else kinds.pop()
        items = tuple(
            self.text(each)
            if isinstance(each, Computed)
            else template((each,))
            if isinstance(each, str)
            else float(each)
            if kind == "float"
            else each
            for each in found
        )
        return _param(name, items, f"list_of_{kind}")

    def described(self, name: str, found: XacroView) -> Element:
        """Return an element that sets a parameter to the text that xacro makes."""
        words = tuple(term for word in self.made.xacro_words(found) for term in word)
        command = Substitution("Command", (joined(words), ("warn",)))
        return _param(name, self.template((command,)), "str")

    def shown_value(self, found: Setting) -> str:
        """Return the value of a parameter for all nodes of a launch file.

        launch writes it into the command lines of nodes as it is: as a text in YAML, it is YAML.
        """
        inside = tuple(self.made.in_quotes(self.made.yaml_pieces(found)))
        return self.text(Computed(('"', *inside, '"')))

    def template(self, terms: Terms) -> str:
        """Return a text with substitutions, which finds files where this one is."""
        return template(tuple(map(self._placed, terms)))

    def _placed(self, term: Term) -> Term:
        if isinstance(term, str):
            return term
        if term.name == "ThisLaunchFileDir" and self._folder is not None:
            self._uses_folder = True
            return self._kept(self._folder, self._folder)
        if term.name == "LaunchConfiguration" and self._hidden is not None:
            name = str(term.operands[0][0])
            return self._kept(f"{self._stem}.{name}", name)
        inside = (tuple(map(self._placed, operand)) for operand in term.operands)
        return Substitution(term.name, tuple(inside))

    def _kept(self, name: str, other: str) -> Term:
        """Return the value that is kept under a name, and is that of another before."""
        if self._hidden is not None:
            self._hidden[name] = _value_of(other)
        return _value_of(name)


class _Substitutions(Substitutions):
    """Makes substitutions that the frontends have, too."""

    def _joined(self, start: Term, folder: str, pieces: tuple[str | Expression, ...]) -> Terms:
        before: Terms = (start, f"/{folder}/" if folder else "/")
        if self._is_relative(pieces[0]):
            return tuple(joined((*before, *self._terms(pieces))))
        is_absolute = self.evaluated(f"{self._literal(pieces)}[:1] == '/'")
        chosen = Substitution("IfElseSubstitution", ((is_absolute,), ("",), before))
        return (chosen, *self._terms(pieces))


def _value_of(name: str, default: str | None = None) -> Substitution:
    operands: list[Terms] = [(name,)]
    if default is not None:
        operands.append((default,))
    return Substitution("LaunchConfiguration", tuple(operands))


def _param(name: str, value: Value, kind: str) -> Element:
    return element("param", name=template((name,)), value=value, type=kind)


def _type_of(value: Scalar) -> str:
    kinds = {bool: "bool", int: "int", float: "float"}
    return kinds.get(type(value), "str")
