"""What becomes of a launch file: nested groups of statements whose texts are not yet written.

They are written when all of the file has been read: the types of its arguments, which decide about
their texts, follow from all uses.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass, field

from deros.importers.launch.values.substitutions import InexpressibleError
from deros.importers.launch.values.writing import Writer
from deros.models.arguments import Condition, Expression
from deros.models.node import BUILT_IN_PARAMETERS, NodeType

Part = str | Callable[[Writer], str]
"""A piece of a line, or what writes one."""
Refuse = Callable[[str, str, int], None]
"""Takes what cannot be said, why, and the line of the launch file."""


@dataclass(frozen=True, slots=True)
class Line:
    """A line of the system.

    Attributes:
        what: it says, for people.
        place: the line of the launch file.
        depth: of its indentation, within its statement.
        parameter: that one node of its group has to have, if it sets one for a group.
    """

    parts: tuple[Part, ...]
    what: str
    place: int
    depth: int = 0
    parameter: str | None = None


Statement = tuple[Line, ...]
"""A program and what belongs to it; without its first line, all of it is left out."""


@dataclass(slots=True)
class Group:
    """A subsystem, or the system itself.

    Attributes:
        head: what stands behind its name.
        namespaces: all in which its members are, the outermost first.
        settings: lines by the word that opens their section, which may be none.
        names: those that are taken.
        set: what is set for the group, so that nothing is twice.
        types: of the nodes below, ``None`` for what starts nodes that are not known.
        has_namespace: whether its head says one.
    """

    name: str
    head: Line | None
    namespaces: tuple[Expression, ...]
    settings: dict[str, list[Line]] = field(default_factory=dict)
    members: list[Group | Statement] = field(default_factory=list)
    names: set[str] = field(default_factory=set)
    set: set[tuple[str, str]] = field(default_factory=set)
    types: list[NodeType | None] = field(default_factory=list)
    has_namespace: bool = False

    @property
    def is_empty(self) -> bool:
        """Whether nothing is started."""
        return all(isinstance(each, Group) and each.is_empty for each in self.members)

    def unused(self, name: str) -> str:
        """Return a name that no member has, and take it."""
        number, found = 2, name
        while found in self.names:
            found, number = f"{name}_{number}", number + 1
        self.names.add(found)
        return found

    def knows(self, parameter: str) -> bool:
        """Return whether a node below may have a parameter."""
        if parameter in BUILT_IN_PARAMETERS and self.types:
            return True
        return any(
            each is None or each.takes_any_parameter or each.parameter_for(parameter) is not None
            for each in self.types
        ) or any(each.knows(parameter) for each in self.members if isinstance(each, Group))


_SECTIONS = ("parameters", "remappings", "topics")
_ORDER = ("files", "topics", "env", "parameters", "remappings")


def written(group: Group, writer: Writer, refuse: Refuse, depth: int = 0) -> Iterator[str]:
    """Yield the lines of all in a group, a blank one before each of its parts."""
    for word in _ORDER:
        lines = [
            text
            for line in group.settings.get(word, ())
            if (text := _line(line, group, writer, refuse)) is not None
        ]
        if not lines:
            continue
        is_section = word in _SECTIONS
        yield ""
        yield from [_indented(word, depth)] if is_section else []
        yield from (_indented(line, depth + is_section) for line in lines)
    for member in group.members:
        if isinstance(member, Group):
            yield from _group(member, writer, refuse, depth)
        else:
            yield from _statement(member, group, writer, refuse, depth)


def _group(group: Group, writer: Writer, refuse: Refuse, depth: int) -> Iterator[str]:
    if group.is_empty:
        return
    head = "" if group.head is None else _line(group.head, group, writer, refuse)
    if head is None:
        return
    yield ""
    yield _indented(f"subsystem {group.name}{head} {{", depth)
    lines = written(group, writer, refuse, depth + 1)
    next(lines)  # the blank one before the first part
    yield from lines
    yield _indented("}", depth)


def _statement(
    found: Statement, group: Group, writer: Writer, refuse: Refuse, depth: int
) -> Iterator[str]:
    first, *others = found
    head = _line(first, group, writer, refuse)
    if head is None:
        return
    yield ""
    yield _indented(head, depth + first.depth)
    for line in others:
        text = _line(line, group, writer, refuse)
        if text is not None:
            yield _indented(text, depth + line.depth)


def _line(found: Line, group: Group, writer: Writer, refuse: Refuse) -> str | None:
    if found.parameter is not None and not group.knows(found.parameter):
        refuse(found.what, "is left out: no node below it has this parameter", found.place)
        return None
    try:
        return "".join(p if isinstance(p, str) else p(writer) for p in found.parts)
    except InexpressibleError as error:
        refuse(found.what, f"is left out: it {error}", found.place)
        return None


def _indented(text: str, depth: int) -> str:
    return f"{'  ' * depth}{text}" if text else ""


# Parts ------------------------------------------------------------------------------------------


def text(found: Expression) -> Part:
    """Return what writes a text."""
    return lambda writer: writer.text(found)


def when(condition: Condition | None, word: str = "when") -> tuple[Part, ...]:
    """Return what writes a condition, if there is one."""
    return () if condition is None else (f" {word} ", lambda writer: writer.when(condition))
