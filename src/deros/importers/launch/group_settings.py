"""What a launch file sets for all that follows in a group."""

from __future__ import annotations

from deros.generators.node.description import parameter_name
from deros.importers.launch.blocks import Line, Part, text, when
from deros.importers.launch.configurations import set_value
from deros.importers.launch.described import identifier
from deros.importers.launch.entities import Entity
from deros.importers.launch.programs import namespace, parameter_file, variable_name
from deros.importers.launch.scopes import File, Scope, both, line_of
from deros.importers.launch.values.conditions import NOWHERE, compared, literally, text_of
from deros.importers.launch.values.expressions import Expressions
from deros.importers.launch.values.settings import Setting, value_of
from deros.importers.launch.values.substitutions import InexpressibleError, pieces_of
from deros.models.arguments import Chosen, Condition, Expression, Interpolation, Literally
from deros.names.names import check_parameter_name


def set_env(file: File, entity: Entity, scope: Scope) -> None:
    """Set a variable of the environment."""
    name = variable_name(file.expressions(scope).of(entity.needed("name")))
    found = set_value(file, entity, scope, name, scope.environment)
    _say_variable(scope, entity, name, found)


def _say_variable(scope: Scope, entity: Entity, name: str, found: Condition | bool) -> None:
    if found is False:
        return
    value = scope.environment[name]
    if isinstance(value, InexpressibleError):
        return
    if found is not True and isinstance(value, Chosen):
        value = value.chosen
    condition = None if isinstance(found, bool) else found
    parts = (f"env {name} = ", text(value), *when(condition))
    _say(scope, entity, "env", name, parts)


def append_env(file: File, entity: Entity, scope: Scope) -> None:
    """Lengthen a variable of the environment."""
    read = file.expressions(scope)
    name = variable_name(read.of(entity.needed("name")))
    value = read.of(entity.needed("value"))
    separator = read.of(entity.get("separator") or ":")
    before = read.of(f"$(env {name} '')")
    is_first = (entity.get("prepend") or "false").strip().lower() in ("true", "1")
    order = (value, separator, before) if is_first else (before, separator, value)
    longer: Expression = text_of(order)
    is_unset = compared("=", before, literally(""))
    if not isinstance(is_unset, bool):
        longer = Chosen(is_unset, value, longer, NOWHERE)
    elif is_unset:
        longer = value
    found = file.condition(entity, scope)
    file.left(entity)
    if found is False:
        return
    condition = both(scope, found)
    new = longer if condition is None else Chosen(condition, longer, before, NOWHERE)
    scope.environment[name] = new
    _say_variable(scope, entity, name, True if condition is None else condition)


def _say(scope: Scope, entity: Entity, word: str, name: str, parts: tuple[Part, ...]) -> None:
    """Add a setting of a group to what follows."""
    group = scope.opened((word, name))
    what = f"'{entity.tag}' {name}"
    parameter = name if word == "parameters" else None
    line = Line(parts, what, entity.line, 0, parameter)
    group.settings.setdefault(word, []).append(line)


def set_parameter(file: File, entity: Entity, scope: Scope) -> None:
    """Set a parameter of all nodes."""
    read = file.expressions(scope)
    name = read.of(entity.needed("name"))
    if not isinstance(name, Literally):
        raise InexpressibleError("has a computed name")
    _parameter(file, entity, scope, str(name.value), entity.needed("value"))


def _parameter(file: File, entity: Entity, scope: Scope, name: str, value: str) -> None:
    if why := check_parameter_name(name):
        raise InexpressibleError(f"has the name '{name}', which {why}")
    read = file.expressions(scope)
    found = file.condition(entity, scope)
    setting = Setting(name, *_yaml_in_yaml(value, read))
    file.left(entity)
    if found is not False:
        parts = (f"param {parameter_name(name)} ", setting.write, *when(both(scope, found)))
        _say(scope, entity, "parameters", name, parts)


def _yaml_in_yaml(
    said: str, read: Expressions
) -> tuple[Expression | tuple[Expression, ...], str | None]:
    """Return a value that is read as YAML twice: by launch, and in a command line by the node."""
    marked = read.marked(pieces_of(said))
    value, kind = value_of(marked, None, False)
    if isinstance(value, tuple) or (
        isinstance(value, Literally) and not isinstance(value.value, str)
    ):
        return value, kind
    if isinstance(value, Literally):
        return value_of(read.marked((str(value.value),)), None, False)
    if isinstance(value, Interpolation):
        inner = read.marked_of(value.pieces)
        return value_of(inner, None, False)
    return value, kind


def set_use_sim_time(file: File, entity: Entity, scope: Scope) -> None:
    """Set ``use_sim_time`` of all nodes."""
    _parameter(file, entity, scope, "use_sim_time", entity.needed("value"))


def set_parameters_from_file(file: File, entity: Entity, scope: Scope) -> None:
    """Have all nodes read a parameter file."""
    found = file.condition(entity, scope)
    if found is False:
        return
    line = parameter_file(file, scope, entity, "filename", 0, both(scope, found))
    file.left(entity)
    scope.opened().settings.setdefault("files", []).append(line)


def set_remap(file: File, entity: Entity, scope: Scope) -> None:
    """Remap a name for all nodes."""
    read = file.expressions(scope)
    source, target = read.of(entity.needed("from")), read.of(entity.needed("to"))
    found = file.condition(entity, scope)
    file.left(entity)
    if found is False:
        return
    if isinstance(source, Literally):
        name = str(source.value)
        if name in scope.remapped:
            raise InexpressibleError("is for a name that is remapped before, which counts")
        scope.remapped.add(name)
    else:
        name = repr(source)
    parts = ("remap ", text(source), " to ", text(target), *when(both(scope, found)))
    _say(scope, entity, "remappings", name, parts)


def push_namespace(file: File, entity: Entity, scope: Scope) -> None:
    """Put all that follows into a namespace."""
    space = namespace(file.expressions(scope).of(entity.needed("namespace")))
    found = file.condition(entity, scope)
    file.left(entity)
    if found is False or space is None:
        return
    condition = both(scope, found)
    if condition is not None:
        space = Chosen(condition, space, literally(""), NOWHERE)
    name = "group"
    if isinstance(space, Literally) and str(space.value) != "/":
        name = identifier(str(space.value).strip("/"))
    group = scope.group
    if group.head is not None and not (group.members or group.settings or group.has_namespace):
        group.head = line_of(entity, " namespace ", text(space), *group.head.parts)
        group.namespaces += (space,)
    else:
        group = scope.open_group(name, line_of(entity, " namespace ", text(space)), space)
    group.has_namespace = True
