"""Nodes, containers and other programs of a launch file."""

from __future__ import annotations

import os
import re
from collections.abc import Iterator
from pathlib import PurePosixPath

from deros.generators.node.description import parameter_name
from deros.importers.launch.blocks import Group, Line, Part, text, when
from deros.importers.launch.described import Used, identifier
from deros.importers.launch.entities import Entity
from deros.importers.launch.ports import remapped
from deros.importers.launch.scopes import File, Scope, both, line_of
from deros.importers.launch.values.conditions import all_of, compared, literally
from deros.importers.launch.values.expressions import Expressions, with_programs
from deros.importers.launch.values.settings import Setting, settings
from deros.importers.launch.values.substitutions import InexpressibleError, pieces_of
from deros.interfaces.durations import duration_text
from deros.interfaces.files import is_file
from deros.models.arguments import Argument, Condition, Expression, Literally
from deros.models.node import BUILT_IN_PARAMETERS
from deros.names.names import check_namespace, check_node_name

_LEVEL = re.compile(r"\s*--log-level\s+(\S.*):=(debug|info|warn|error|fatal)\s*", re.IGNORECASE)
_GIVEN = re.compile(r"[A-Za-z_][\w/-]*", re.ASCII)
"""What an argument of a launch file is called; other names are of use within the file alone."""
_BOOLS = frozenset({"true", "True", "1"})


class Programs:
    """Makes the statements of programs in one scope."""

    def __init__(self, file: File, scope: Scope) -> None:
        """Make those of a scope."""
        self.file = file
        self.scope = scope
        self.read = file.expressions(scope)

    # Nodes --------------------------------------------------------------------------------------

    def node(self, entity: Entity) -> None:
        """Add a node that is a process."""
        found = self.file.condition(entity, self.scope)
        if found is False:
            return self.never(entity)
        package = self.literal(entity, "pkg")
        is_managed = entity.tag == "lifecycle_node" and entity.get("autostart") in _BOOLS
        used = self.file.types.program(package, self.literal(entity, "exec"), is_managed)
        name, is_own = self._node_name(entity, used)
        words: list[tuple[Part, ...]] = [(" own_name",)] if is_own else []
        if is_managed:
            words.append((" autostart",))
        words += self.arguments(entity, name)
        words += self.process_words(entity)
        self.add(entity, name, used, words, both(self.scope, found))
        return None

    def add(
        self,
        entity: Entity,
        name: str,
        used: Used,
        words: list[tuple[Part, ...]],
        condition: Condition | None,
    ) -> None:
        """Add a node with its settings, in a group of its own where that is needed."""
        space = self.namespace(entity)
        into = [word for word in words if word[:1] == (" into ",)]
        words = [word for word in words if word[:1] != (" into ",)]
        home = self._home(name, used, space)
        if home is self.scope.group and space is not None:
            words.insert(0, (" namespace ", text(space)))
        home.types.append(used.model)
        label = f"'{entity.tag}' {name}"
        head = (f"node {name} : {used.name}", *(p for word in words for p in word))
        # A condition behind `into` is about that alone.
        behind = (part for word in into for part in word)
        lines = [line_of(entity, *head, *when(condition), *behind, what=label)]
        lines += self.settings(entity, used)
        is_sure = self.scope.is_sure and condition is None
        inner = space if home is self.scope.group else None
        lines += remapped(self.file, self.scope, home, entity, used.model, name, inner, is_sure)
        self.file.left(entity)
        home.members.append(tuple(lines))

    def _home(self, name: str, used: Used, space: Expression | None) -> Group:
        """Return the group of a node: one of its own if it shares its name, or is to be wired."""
        group = self.scope.group
        spaces = [*group.namespaces, *([] if space is None else [space])]
        is_computed = not all(isinstance(each, Literally) for each in spaces)
        is_wired = used.model is not None and used.model.ports and is_computed and space is not None
        if name not in group.names and not is_wired:
            group.names.add(name)
            return group
        head: tuple[Part, ...] = () if space is None else (" namespace ", text(space))
        inner_spaces = (*group.namespaces, *([] if space is None else [space]))
        inner = Group(group.unused(name), Line(head, name, 0), inner_spaces, names={name})
        group.members.append(inner)
        return inner

    def _node_name(self, entity: Entity, used: Used) -> tuple[str, bool]:
        """Return the name of a node, and whether its program chooses it."""
        said = entity.get("name")
        if said is None:
            name = identifier(used.name)
            return name, True
        found = self.read.of(said)
        if not isinstance(found, Literally):
            name = identifier(re.sub(r"\$\([^)]*\)", "", said).strip("_") or used.name)
            why = f"is computed, which a system cannot say: it is '{name}' here"
            self.file.refuse(f"the name of '{entity.tag}'", why, entity.line)
            return name, False
        fault = check_node_name(str(found.value))
        if fault:
            raise InexpressibleError(f"has the name '{found.value}', which {fault}")
        return str(found.value), False

    def namespace(self, entity: Entity) -> Expression | None:
        """Return the namespace of a node, if it says one."""
        said = entity.get("namespace")
        return None if said is None else namespace(self.read.of(said))

    def settings(self, entity: Entity, used: Used) -> Iterator[Line]:
        """Yield the parameter files and parameters of a node."""
        found: dict[str, tuple[Setting, Entity]] = {}
        for each in entity.details("param"):
            try:
                if each.get("from") is not None:
                    if found:
                        self.file.refuse(
                            "'param' from a file behind others",
                            "counts less than these in a system, and more for launch",
                            each.line,
                        )
                    yield parameter_file(self.file, self.scope, each, "from", 0, None)
                    self.file.left(each)
                    continue
                for setting in settings(each, self.read, used.model):
                    found[setting.name] = (setting, each)
                self.file.left(each)
            except InexpressibleError as error:
                self.file.refuse("'param'", f"is left out: it {error}", each.line)
        kept = [e for e in found.values() if self._is_known(e[0], used, e[1])]
        if kept:
            yield line_of(entity, "parameters")
        for setting, place in kept:
            what = f"parameter '{setting.name}'"
            parts = (f"param {parameter_name(setting.name)} ", setting.write)
            yield line_of(place, *parts, depth=1, what=what)

    def _is_known(self, setting: Setting, used: Used, entity: Entity) -> bool:
        model, name = used.model, setting.name
        if model is None or model.takes_any_parameter or model.parameter_for(name) is not None:
            return True
        if name in BUILT_IN_PARAMETERS or name.startswith("qos_overrides."):
            return True
        why = f"is left out: node type '{used.name}' does not declare it"
        self.file.refuse(f"parameter '{name}'", why, entity.line)
        return False

    # Processes ----------------------------------------------------------------------------------

    def executable(self, entity: Entity) -> None:
        """Add a process that is not a node."""
        found = self.file.condition(entity, self.scope)
        if found is False:
            return self.never(entity)
        command = entity.needed("cmd")
        program: Expression
        if (entity.get("shell") or "false") in _BOOLS:
            program, *words = literally("sh"), literally("-c"), self.read.of(command)
        else:
            program, *words = _words(self.read, command) or [literally("")]
        name = self._process_name(entity, program)
        parts: list[Part] = [f"process {name} : ", text(program)]
        parts += _listed(words)
        for word in self.process_words(entity):
            parts += word
        if (folder := entity.get("cwd")) is not None:
            parts += [" cwd ", text(self.read.of(folder))]
        condition = both(self.scope, found)
        self.file.left(entity)
        head = line_of(entity, *parts, *when(condition), what=f"'executable' {name}")
        self.scope.group.members.append((head,))
        return None

    def _process_name(self, entity: Entity, program: Expression) -> str:
        said = entity.get("name")
        name = self.read.of(said) if said is not None else program
        if isinstance(name, Literally) and str(name.value):
            stem = str(name.value) if said is not None else PurePosixPath(str(name.value)).name
        else:
            stem = "process"
        return self.scope.group.unused(identifier(stem))

    def process_words(self, entity: Entity) -> list[tuple[Part, ...]]:
        """Return what nodes and other programs have in common."""
        words: list[tuple[Part, ...]] = []
        for each in entity.details("env"):
            words += self._variable(each)
        if (prefix := entity.get("launch-prefix")) is not None:
            words.append((" prefix ", text(self.read.of(prefix))))
        if (output := entity.get("output")) not in (None, "screen"):
            why = "is left out: all output of the programs of a system is shown"
            self.file.refuse(f'output="{output}"', why, entity.line)
        if self.scope.delay_ns:
            words.append((f" delay {duration_text(self.scope.delay_ns)}",))
        words.append(self._respawn(entity))
        end = entity.get("on_exit")
        if end == "shutdown":
            words.append((" on exit stop all",))
        elif end is not None:
            raise InexpressibleError(f"has on_exit=\"{end}\", and launch takes 'shutdown' alone")
        return words

    def _variable(self, entity: Entity) -> Iterator[tuple[Part, ...]]:
        try:
            name = variable_name(self.read.of(entity.needed("name")))
            value = self.read.of(entity.needed("value"))
        except InexpressibleError as error:
            self.file.refuse("'env'", f"is left out: it {error}", entity.line)
            return
        self.file.left(entity)
        yield (f" env {name} = ", text(value))

    def _respawn(self, entity: Entity) -> tuple[Part, ...]:
        """Return when it is started again; one whose end stops all never is."""
        said, pause = entity.get("respawn"), entity.get("respawn_delay")
        most = entity.get("respawn_max_retries")
        if said is None:
            return ()
        parts: list[Part] = [" respawn"]
        only = self.read.condition(said)
        if only is False:
            return ()
        if entity.get("on_exit") == "shutdown":
            why = "is left out: the end of the program stops all"
            self.file.refuse(f"'respawn' of '{entity.tag}'", why, entity.line)
            return ()
        if pause is not None:
            parts.append(f" delay {duration_text(seconds(pause))}")
        if most is not None:
            if not re.fullmatch(r"-?\d{1,9}", most.strip()):
                raise InexpressibleError(f'has respawn_max_retries="{most}", which is no integer')
            if int(most) >= 0:
                parts.append(f" max {int(most)}")
        if only is not True:
            parts += when(only, "if")
        return tuple(parts)

    def arguments(self, entity: Entity, name: str) -> list[tuple[Part, ...]]:
        """Return the words of a command line, those for ROS 2 included."""
        words = _words(self.read, entity.get("args") or "")
        given = entity.get("ros_args") or ""
        level = _LEVEL.fullmatch(given)
        if level is not None and re.search(rf"(?:^|[./)]){re.escape(name)}$", level[1]):
            return [tuple(_listed(words)), (f" log_level {level[2].lower()}",)]
        if given.strip():
            words += [literally("--ros-args"), *_words(self.read, given), literally("--")]
        return [tuple(_listed(words))]

    def literal(self, entity: Entity, name: str) -> str:
        """Return an attribute in which nothing is computed."""
        found = self.read.of(entity.needed(name))
        if not isinstance(found, Literally):
            raise InexpressibleError(f"has a computed '{name}'")
        return str(found.value)

    def never(self, entity: Entity) -> None:
        """Note that an action is never executed."""
        self.file.refuse(f"'{entity.tag}'", "is left out: its condition never holds", entity.line)


def _words(read: Expressions, command: str) -> list[Expression]:
    """Return the words of a command line; a program that launch looks up is so in any case."""
    return read.words(with_programs(pieces_of(command)))


def _listed(words: list[Expression]) -> list[Part]:
    if not words:
        return []
    parts: list[Part] = [" arguments ["]
    for number, word in enumerate(words):
        parts += [", "] * bool(number) + [text(word)]
    return [*parts, "]"]


def seconds(said: str) -> int:
    """Return a time in nanoseconds."""
    try:
        found = float(said)
    except ValueError:
        found = -1.0
    if not 0 <= found < 1e9:
        raise InexpressibleError(f"has a time that is not a number of seconds: '{said}'")
    return round(found * 1e9)


def namespace(found: Expression) -> Expression | None:
    """Return a namespace, ``None`` for an empty one.

    Raises:
        InexpressibleError: there can be no such namespace.
    """
    if not isinstance(found, Literally):
        return found
    name = str(found.value)
    name = name.rstrip("/") or name[:1]
    if not name:
        return None
    if why := check_namespace(name):
        raise InexpressibleError(f"has the namespace '{name}', which {why}")
    return literally(name)


def variable_name(found: Expression) -> str:
    """Return the name of a variable of the environment."""
    name = str(found.value) if isinstance(found, Literally) else ""
    if not re.fullmatch(r"[A-Za-z_]\w*", name, re.ASCII):
        raise InexpressibleError("has a name that no variable in a system can have")
    return name


def parameter_file(
    file: File, scope: Scope, entity: Entity, name: str, depth: int, condition: Condition | None
) -> Line:
    """Return the line that reads a parameter file; launch takes none by an empty path.

    Raises:
        InexpressibleError: there is no such file.
    """
    read = file.expressions(scope)
    path = read.path(entity.needed(name))
    refuse_absent(file, path)
    if isinstance(path, Argument):
        default = file.declared[path.name].default
        if isinstance(default, Literally) and default.value == "":
            is_there = all_of([compared("!=", path, default), condition or True])
            condition = None if isinstance(is_there, bool) else is_there
    given: tuple[Part, ...] = ()
    substituted = entity.get("allow_substs")
    if substituted is not None and read.condition(substituted) is not False:
        given = (" (", *arguments(visible(scope)), ")")
    what = "a parameter file"
    return line_of(
        entity, "parameters from ", text(path), *given, *when(condition), depth=depth, what=what
    )


def refuse_absent(file: File, path: Expression) -> None:
    """Refuse a file that is not there, if that can be known.

    Raises:
        InexpressibleError: there is no such file.
    """
    if isinstance(path, Literally) and not str(path.value).startswith("share:"):
        name = str(path.value)
        if not name or not is_file(os.path.normpath(file.output / name)):
            raise InexpressibleError(f"names '{name}', and there is no such file")


def visible(scope: Scope) -> dict[str, Expression]:
    """Return the configurations that a file which is read sees."""
    return {
        name: value
        for name, value in scope.values.items()
        if not isinstance(value, InexpressibleError) and _GIVEN.fullmatch(name)
    }


def arguments(values: dict[str, Expression]) -> list[Part]:
    """Return values that are given to a file."""
    parts: list[Part] = []
    for number, (name, value) in enumerate(values.items()):
        parts += [", "] * bool(number)
        parts += [f"{parameter_name(name)} = ", _passed(value)]
    return parts


def _passed(found: Expression) -> Part:
    return lambda writer: writer.passed(found)
