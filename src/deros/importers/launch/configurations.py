"""Arguments of a launch file, and the configurations that it computes from them."""

from __future__ import annotations

from deros.importers.launch.blocks import Line
from deros.importers.launch.entities import Entity
from deros.importers.launch.scopes import File, NotSetError, Scope, both
from deros.importers.launch.values.argument_types import Declared
from deros.importers.launch.values.conditions import NOWHERE, literally
from deros.importers.launch.values.substitutions import InexpressibleError
from deros.models.arguments import Chosen, Condition, Expression, Literally


def arg(file: File, entity: Entity, scope: Scope) -> None:
    """Declare an argument."""
    said = entity.needed("name")
    name = file.argument_name(said, entity.line)
    read = file.expressions(scope)
    default = None
    if (given := entity.get("default")) is not None:
        try:
            default = read.of(given)
        except InexpressibleError as error:
            why = f"is left out, so that it has to be given: it {error}"
            file.refuse(f"the default of argument '{said}'", why, entity.line)
    choices = []
    for each in entity.details("choice"):
        choice = read.of(each.needed("value"))
        if not isinstance(choice, Literally):
            raise InexpressibleError("has a computed choice")
        choices.append(str(choice.value))
    description = read.of(entity.get("description") or "")
    said_of_it = str(description.value) if isinstance(description, Literally) else ""
    if file.condition(entity, scope) is not True or scope.when is not None:
        why = "is declared in any case, and only under a condition in the launch file"
        file.refuse(f"argument '{said}'", why, entity.line)
    file.left(entity)
    found = Declared(name, default, tuple(choices), _one_line(said_of_it), entity.line)
    if said not in scope.values:
        scope.values[said] = file.argument(found)


def _one_line(said: str) -> str:
    return " ".join("".join(e if e.isprintable() else " " for e in said).split())


def let(file: File, entity: Entity, scope: Scope) -> None:
    """Set a configuration."""
    name = entity.needed("name")
    literal = file.expressions(scope).of(name)
    if not isinstance(literal, Literally):
        raise InexpressibleError("has a computed name")
    name = str(literal.value)
    set_value(file, entity, scope, name, scope.values)


def reset(file: File, entity: Entity, scope: Scope) -> None:
    """Forget all configurations that are not kept."""
    if file.condition(entity, scope) is not True or scope.when is not None:
        raise InexpressibleError("is under a condition")
    keep_only(file, entity.details("keep"), scope)
    file.left(entity)


def keep_only(file: File, kept: list[Entity], scope: Scope) -> None:
    """Forget all configurations but some, which may have other values from now on."""
    before = scope.inside(scope.group, None)
    scope.values.clear()
    scope.sees_outside = False
    names = set()
    for each in kept:
        name = file.expressions(before).of(each.needed("name"))
        if not isinstance(name, Literally):
            raise InexpressibleError("has a computed name in 'keep'")
        names.add(str(name.value))
        if str(name.value) != "ros_namespace":
            keep(file, each, before, scope, str(name.value))
    if "ros_namespace" not in names and scope.group.namespaces:
        space = literally("/")
        head = Line((" namespace /",), "the root namespace", 0)
        scope.open_group("root", head, space)


def keep(file: File, entity: Entity, before: Scope, scope: Scope, name: str) -> None:
    """Set a configuration to what it is ``before`` others are forgotten."""
    try:
        scope.values[name] = file.expressions(before).of(entity.needed("value"))
    except InexpressibleError as error:
        unsaid = NotSetError(name, str(error), entity.line)
        file.unsaid.append(unsaid)
        scope.values[name] = unsaid


def set_value(
    file: File,
    entity: Entity,
    scope: Scope,
    name: str,
    values: dict[str, Expression | InexpressibleError],
) -> Condition | bool:
    """Set a value, and return when; what it is where that does not hold is what it was before."""
    found = file.condition(entity, scope)
    condition = None if found is False else both(scope, found)
    if found is False:
        return False
    try:
        value: Expression = file.expressions(scope).of(entity.needed("value"))
        if condition is not None:
            before = values.get(name)
            if isinstance(before, InexpressibleError):
                raise before
            otherwise = literally("") if before is None else before
            value = Chosen(condition, value, otherwise, NOWHERE)
        values[name] = value
    except InexpressibleError as error:
        unsaid = NotSetError(name, str(error), entity.line)
        file.unsaid.append(unsaid)
        values[name] = unsaid
    file.left(entity)
    return True if condition is None else condition
