"""Containers of a launch file, and the nodes that are loaded into them."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace

from deros.importers.launch.blocks import Part, Statement, text, when
from deros.importers.launch.entities import Entity
from deros.importers.launch.ports import remapped
from deros.importers.launch.programs import Programs
from deros.importers.launch.scopes import both, line_of
from deros.importers.launch.values.conditions import NOWHERE, all_of, compared, text_of
from deros.importers.launch.values.substitutions import InexpressibleError
from deros.models.arguments import Argument, Chosen, Condition, Expression, Literally, merged
from deros.names.names import check_node_name

_CONTAINERS = {
    "component_container": "",
    "component_container_mt": " multi_threaded",
    "component_container_isolated": " isolated",
}


class Containers(Programs):
    """Makes the statements of containers in one scope."""

    def container(self, entity: Entity) -> None:
        """Add a container and what is loaded into it."""
        found = self.file.condition(entity, self.scope)
        if found is False:
            return self.never(entity)
        package, program = self.literal(entity, "pkg"), self.literal(entity, "exec")
        threads = _CONTAINERS.get(program)
        if package != "rclcpp_components" or threads is None:
            why = f"is not '{package}/{program}' in the model, but 'component_container'"
            self.file.refuse("the program of 'node_container'", why, entity.line)
        name = self.literal(entity, "name")
        _checked(name)
        parts: list[Part] = [f"container {self.scope.group.unused(name)}{threads or ''}"]
        space = self.namespace(entity)
        if space is not None:
            parts += [" namespace ", text(space)]
        for word in [*self.arguments(entity, name), *self.process_words(entity)]:
            parts += word
        lines = [line_of(entity, *parts, *when(both(self.scope, found)), " {", what=f"'{name}'")]
        for each in entity.details("composable_node"):
            lines += self._component(each, None, found is True)
        self.file.left(entity)
        self.scope.group.members.append((*lines, line_of(entity, "}")))
        return None

    def loaded(self, entity: Entity) -> None:
        """Add what is loaded into a container that stands elsewhere."""
        found = self.file.condition(entity, self.scope)
        if found is False:
            return self.never(entity)
        target = self.read.of(entity.needed("target"))
        target = self._absolute(target, entity)
        for each in entity.details("composable_node"):
            self._component(each, target, found is True, found)
        self.file.left(entity)
        return None

    def _absolute(self, target: Expression, entity: Entity) -> Expression:
        """Return the name of a container from the root, where launch looks for it."""
        if isinstance(target, Argument):
            default = self.file.declared[target.name].default
            if isinstance(default, Literally) and str(default.value).startswith("/"):
                why = f"is that of argument '{target.name}', and always its default in the model"
                self.file.refuse("the container of 'load_composable_node'", why, entity.line)
                return default
        first, *rest = *merged((target,)), ""
        if isinstance(first, str) and first.startswith("/"):
            return target
        if isinstance(first, Argument) and isinstance(rest[0], str) and rest[0].startswith("/"):
            default = self.file.declared[first.name].default
            if isinstance(default, Literally) and default.value == "":  # the root, then
                is_root = compared("=", first, default)
                assert not isinstance(is_root, bool)
                below = text_of((rest[0][1:], *rest[1:]))
                target = Chosen(is_root, below, target, NOWHERE)
        return text_of(("/", target))

    def _component(
        self,
        entity: Entity,
        target: Expression | None,
        is_sure: bool,
        outer: Condition | bool = True,
    ) -> Statement:
        """Return a node in braces, or add one that is loaded into a container elsewhere."""
        try:
            return self._component_lines(entity, target, is_sure, outer)
        except InexpressibleError as error:
            self.file.refuse("'composable_node'", f"is left out: it {error}", entity.line)
            return ()

    def _component_lines(
        self, entity: Entity, target: Expression | None, is_sure: bool, outer: Condition | bool
    ) -> Statement:
        found = self.file.condition(entity, self.scope)
        if found is False:
            self.never(entity)
            return ()
        used = self.file.types.component(
            self.literal(entity, "pkg"), self.literal(entity, "plugin")
        )
        name = self.literal(entity, "name")
        _checked(name)
        words: list[tuple[Part, ...]] = []
        for each in entity.details("extra_arg"):
            words += self._extra(each)
        if target is not None:
            words.append((" into ", text(target)))
            joined = all_of([found, outer])
            self.add(entity, name, used, words, both(self.scope, joined))
            return ()
        space = self.namespace(entity)
        if space is not None:
            words.insert(0, (" namespace ", text(space)))
        home = self.scope.group
        home.types.append(used.model)
        home.names.add(name)
        condition = None if isinstance(found, bool) else found
        head = (f"node {name} : {used.name}", *(p for word in words for p in word))
        what = f"'composable_node' {name}"
        lines = [line_of(entity, *head, *when(condition), depth=1, what=what)]
        below = [
            *self.settings(entity, used),
            *remapped(
                self.file,
                self.scope,
                home,
                entity,
                used.model,
                name,
                space,
                is_sure and self.scope.is_sure and condition is None,
            ),
        ]
        self.file.left(entity)
        return (*lines, *(replace(each, depth=each.depth + 1) for each in below))

    def _extra(self, entity: Entity) -> Iterator[tuple[Part, ...]]:
        name = self.literal(entity, "name")
        if name != "use_intra_process_comms":
            self.file.refuse(
                f"extra_arg '{name}'", "is left out: a system cannot say it", entity.line
            )
            return
        only = self.read.condition(entity.needed("value"))
        if only is True:
            yield (" intra_process",)
        elif only is not False:
            yield (" intra_process", *when(only, "if"))


def _checked(name: str) -> None:
    if why := check_node_name(name):
        raise InexpressibleError(f"has the name '{name}', which {why}")
