"""The actions of a launch file, in the order in which launch executes them."""

from __future__ import annotations

import re
from collections.abc import Callable, Iterator, Mapping
from pathlib import PurePosixPath

from deros.importers.launch import configurations, group_settings
from deros.importers.launch.blocks import Part, text, when
from deros.importers.launch.containers import Containers
from deros.importers.launch.described import identifier
from deros.importers.launch.entities import Entity
from deros.importers.launch.included import LAUNCH_ENDINGS, taken
from deros.importers.launch.programs import Programs, arguments, refuse_absent, seconds, visible
from deros.importers.launch.scopes import File, Scope, both, line_of
from deros.importers.launch.values.substitutions import InexpressibleError
from deros.metamodels.launch_files.elements import Element
from deros.models.arguments import Expression, Literally


def walk(file: File, root: Element) -> None:
    """Take all actions of a file into its model."""
    scope = Scope(file.root)
    _actions(file, root.children, scope)
    for unsaid in file.unsaid:
        if not unsaid.is_used:
            what = f"the value of '{unsaid.name}'"
            file.refuse(what, f"is left out, and nothing uses it: it {unsaid.why}", unsaid.line)


def _actions(file: File, elements: list[Element], scope: Scope) -> None:
    for element in elements:
        entity = Entity(element)
        action = _ACTIONS.get(entity.tag)
        if action is None:
            why = "is left out: a system cannot say it"
            if entity.tag.startswith("log"):
                why = "is left out: a system has no messages of its own"
            file.refuse(f"'{entity.tag}'", why, entity.line)
            continue
        try:
            action(file, entity, scope)
        except InexpressibleError as error:
            file.refuse(f"'{entity.tag}'", f"is left out: it {error}", entity.line)


def _node(file: File, entity: Entity, scope: Scope) -> None:
    Programs(file, scope).node(entity)


def _container(file: File, entity: Entity, scope: Scope) -> None:
    Containers(file, scope).container(entity)


def _loaded(file: File, entity: Entity, scope: Scope) -> None:
    Containers(file, scope).loaded(entity)


def _executable(file: File, entity: Entity, scope: Scope) -> None:
    Programs(file, scope).executable(entity)


# What holds actions -----------------------------------------------------------------------------


def _group(file: File, entity: Entity, scope: Scope) -> None:
    found = file.condition(entity, scope)
    if found is False:
        file.refuse("'group'", "is left out: its condition never holds", entity.line)
        return
    is_scoped = _is_true(entity.get("scoped"), True)
    forwards = _is_true(entity.get("forwarding"), True)
    kept = entity.details("keep")
    if not is_scoped:
        before = scope.when
        scope.when = both(scope, found)
        _actions(file, entity.children(), scope)
        scope.when = before
        file.left(entity)
        return
    condition = both(scope, found)
    group, inner = scope.group, scope.inside(scope.group, None)
    head = line_of(entity, *when(condition))
    inner.open_group(_group_name(file, entity, scope), head)
    inner.is_sure = scope.is_sure and condition is None
    if not forwards or kept:
        configurations.keep_only(file, kept, inner) if not forwards else _add_kept(
            file, kept, inner
        )
    _actions(file, entity.children(), inner)
    scope.group = group
    file.left(entity)


def _group_name(file: File, entity: Entity, scope: Scope) -> str:
    """Return a name for a group: that of its namespace, if it begins with one."""
    first = next(iter(entity.element.children), None)
    if first is not None and first.tag in ("push_ros_namespace", "push-ros-namespace"):
        try:
            space = file.expressions(scope).of(first.attributes.get("namespace", ""))
        except InexpressibleError:
            return "group"
        name = str(space.value).strip("/") if isinstance(space, Literally) else ""
        return identifier(name) if name else "group"
    return "group"


def _add_kept(file: File, kept: list[Entity], scope: Scope) -> None:
    for each in kept:
        name = file.expressions(scope).of(each.needed("name"))
        if isinstance(name, Literally):
            configurations.keep(file, each, scope, scope, str(name.value))


def _is_true(said: str | None, default: bool) -> bool:
    if said is None:
        return default
    word = said.strip().lower()
    if word not in ("true", "false", "1", "0", "yes", "no", "on", "off"):
        raise InexpressibleError(f"has '{said}' where launch takes true or false")
    return word in ("true", "1", "yes", "on")


def _timer(file: File, entity: Entity, scope: Scope) -> None:
    found = file.condition(entity, scope)
    if found is False:
        return
    period = file.expressions(scope).of(entity.needed("period"))
    if not isinstance(period, Literally):
        raise InexpressibleError("has a computed period")
    before = scope.when, scope.delay_ns
    scope.when = both(scope, found)
    scope.delay_ns += seconds(str(period.value))
    _actions(file, entity.children(), scope)
    scope.when, scope.delay_ns = before
    file.left(entity)


def _include(file: File, entity: Entity, scope: Scope) -> None:
    found = file.condition(entity, scope)
    if found is False:
        file.refuse("'include'", "is left out: its condition never holds", entity.line)
        return
    read = file.expressions(scope)
    said = entity.needed("file")
    path = read.path(said)
    refuse_absent(file, path)
    if isinstance(path, Literally) and not str(path.value).endswith(LAUNCH_ENDINGS):
        raise InexpressibleError(f"names '{said}', which launch does not read")
    given: dict[str, Expression] = {}
    for each in [*entity.details("arg"), *entity.details("let")]:
        given.update(_given(file, each, scope))
    if scope.delay_ns:
        why = "is left out: a launch file is started with the system"
        file.refuse("the delay of 'include'", why, entity.line)
    others = {name: e for name, e in visible(scope).items() if name not in given}
    accepted = taken(file, path)
    if accepted is not None:
        others = {name: value for name, value in others.items() if name in accepted}
        for refused in [each for each in given if each not in accepted]:
            why = "is left out: the launch file does not take it"
            file.refuse(f"the value of '{refused}' for 'include'", why, entity.line)
            del given[refused]
    passed = {**given, **others}
    parts: list[Part] = ["launch ", text(path)]
    if passed:
        parts += [" (", *arguments(passed), ")"]
    stem = _stem(path)
    taken_name = scope.group.unused(identifier(stem or "included"))
    if taken_name != stem:
        parts.append(f" as {taken_name}")
    file.left(entity)
    scope.group.types.append(None)
    line = line_of(entity, *parts, *when(both(scope, found)), what=f"'include' of {said}")
    scope.group.members.append((line,))


def _given(file: File, entity: Entity, scope: Scope) -> Iterator[tuple[str, Expression]]:
    read = file.expressions(scope)
    try:
        name = read.of(entity.needed("name"))
        if not isinstance(name, Literally):
            raise InexpressibleError("has a computed name")
        value = read.of(entity.needed("value"))
    except InexpressibleError as error:
        file.refuse("'arg' of 'include'", f"is left out: it {error}", entity.line)
        return
    file.left(entity)
    yield str(name.value), value


def _stem(path: Expression) -> str:
    """Return the name that a launch file gives its statement; empty if it is not known."""
    if not isinstance(path, Literally):
        return ""
    return re.sub(r"(?:[._]launch)?\.(?:py|xml|ya?ml)$", "", PurePosixPath(str(path.value)).name)


_ACTIONS: Mapping[str, Callable[[File, Entity, Scope], None]] = {
    "append_env": group_settings.append_env,
    "arg": configurations.arg,
    "executable": _executable,
    "group": _group,
    "include": _include,
    "let": configurations.let,
    "lifecycle_node": _node,
    "load_composable_node": _loaded,
    "node": _node,
    "node_container": _container,
    "push_ros_namespace": group_settings.push_namespace,
    "reset": configurations.reset,
    "ros_timer": _timer,
    "set_env": group_settings.set_env,
    "set_parameter": group_settings.set_parameter,
    "set_parameters_from_file": group_settings.set_parameters_from_file,
    "set_remap": group_settings.set_remap,
    "set_use_sim_time": group_settings.set_use_sim_time,
    "timer": _timer,
}
