"""What programs are started with, and the settings of groups, for values of the arguments."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace
from typing import Protocol, TypeVar

from deros.models.arguments import Condition, Expression
from deros.models.common import Scalar
from deros.models.composition import Into
from deros.models.programs import ProcessInstance, Remapping, Respawn, Variable, Word
from deros.models.starting import Starting
from deros.models.system import NodeInstance, SafetyInstance
from deros.systems.arguments.evaluate import CannotEvaluate
from deros.systems.arguments.scopes import Scope


class _Conditional(Protocol):
    @property
    def when(self) -> Condition | None: ...


Conditional = TypeVar("Conditional", bound=_Conditional)
Started = TypeVar("Started", NodeInstance, SafetyInstance)


class ProgramResolution:
    """The part of a resolution that is about programs; the rest says what expressions are worth."""

    faults: list[CannotEvaluate]

    def value(self, expression: Expression, scope: Scope) -> Scalar | None:
        """Return the value of an expression; ``None`` where it has none."""
        raise NotImplementedError

    def holds(self, condition: Condition, scope: Scope) -> bool:
        """Return whether a condition holds."""
        raise NotImplementedError

    def text(self, plain: str, expression: Expression | None, scope: Scope) -> str | None:
        """Return a name, computed if it is; ``None`` where it has no value."""
        raise NotImplementedError

    def present(self, parts: tuple[Conditional, ...], scope: Scope) -> Iterator[Conditional]:
        """Yield the parts whose conditions hold."""
        return (each for each in parts if each.when is None or self.holds(each.when, scope))

    def started(self, part: Started, scope: Scope) -> Started:
        """Return a part with what its programs are started with."""
        if not part.environment and part.prefix is None and part.respawn is None:
            return part
        return replace(
            part,
            environment=self.variables(part.environment, scope),
            prefix=self._optional(part.prefix, scope),
            respawn=self._respawn(part.respawn, scope),
        )

    def switched(self, node: NodeInstance, scope: Scope) -> NodeInstance:
        """Return a node with what holds of its kind."""
        other, shared = node.other_type, node.intra_process
        if other is not None:
            node_type = other.type if self.holds(other.when, scope) else node.type
            node = replace(node, type=node_type, other_type=None)
        if shared is not None and shared.when is not None:
            kept = replace(shared, when=None) if self.holds(shared.when, scope) else None
            node = replace(node, intra_process=kept)
        return node

    def starting(self, found: Starting, scope: Scope) -> Starting:
        """Return when a program is started; what has no name is not waited for."""
        ready = found.ready
        if ready is None or ready.name_from is None:
            return found
        name = self.text(ready.name, ready.name_from, scope)
        named = None if name is None else replace(ready, name=name, name_from=None)
        return replace(found, ready=named)

    def _respawn(self, found: Respawn | None, scope: Scope) -> Respawn | None:
        if found is None or found.when is None:
            return found
        return replace(found, when=None) if self.holds(found.when, scope) else None

    def words(self, found: tuple[Word, ...], scope: Scope) -> tuple[Word, ...]:
        """Return texts for a program; what has no value is left out."""
        words = (self._word(each, scope) for each in self.present(found, scope))
        return tuple(each for each in words if each is not None)

    def variables(self, found: tuple[Variable, ...], scope: Scope) -> tuple[Variable, ...]:
        """Return environment variables."""
        variables = []
        for each in self.present(found, scope):
            value = self._word(each.value, scope)
            if value is not None:
                variables.append(replace(each, value=value, when=None))
        return tuple(variables)

    def into(self, found: Into | None, scope: Scope) -> Into | None:
        """Return where a node is loaded; ``None`` where it is a process of its own."""
        if found is None or (found.when is not None and not self.holds(found.when, scope)):
            return None
        container = self.text(found.container, found.container_from, scope)
        if container is None:
            return None
        computed = found.container_from is not None
        return replace(
            found, container=container, container_from=None, when=None, is_computed=computed
        )

    def remappings(self, found: tuple[Remapping, ...], scope: Scope) -> tuple[Remapping, ...]:
        """Return the remappings of a node or a group."""
        remappings = []
        for each in self.present(found, scope):
            name = self.text(each.name, each.name_from, scope)
            target = self.text(each.target, each.target_from, scope)
            if name is not None and target is not None:
                plain = replace(each, name_from=None, target_from=None, when=None)
                remappings.append(replace(plain, name=name, target=target))
        return tuple(remappings)

    def processes(
        self, found: tuple[ProcessInstance, ...], scope: Scope
    ) -> tuple[ProcessInstance, ...]:
        """Return the processes that are there."""
        processes = []
        for each in self.present(found, scope):
            program = self._word(each.program, scope)
            if program is not None:
                processes.append(
                    replace(
                        each,
                        program=program,
                        arguments=self.words(each.arguments, scope),
                        environment=self.variables(each.environment, scope),
                        prefix=self._optional(each.prefix, scope),
                        folder=self._optional(each.folder, scope),
                        respawn=self._respawn(each.respawn, scope),
                        when=None,
                        starting=self.starting(each.starting, scope),
                    )
                )
        return tuple(processes)

    def _optional(self, word: Word | None, scope: Scope) -> Word | None:
        return None if word is None else self._word(word, scope)

    def _word(self, word: Word, scope: Scope) -> Word | None:
        if word.text_from is None:
            return word
        value = self.value(word.text_from, scope)
        if value is None:
            return None
        if isinstance(value, bool | float):
            what = "a bool" if isinstance(value, bool) else "a double"
            message = f"a program is given texts and integers, and this is {what}: {value!r}"
            self.faults.append(CannotEvaluate(message, word.text_from.span))
            return None
        return replace(word, text=str(value), text_from=None)
