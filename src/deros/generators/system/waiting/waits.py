"""Full names of the nodes, services and topics that programs wait for."""

from __future__ import annotations

from collections import defaultdict
from dataclasses import replace

from deros import codes
from deros.diagnostics import Span, report
from deros.generators.api.protocol import GenerationError
from deros.generators.system.computed import Computed, Text
from deros.generators.system.expanded import expanded
from deros.generators.system.programs import NodeView, ProcessView
from deros.generators.system.settings import marked_text
from deros.generators.system.waiting.wait_view import WaitView
from deros.models.arguments import Chosen, Condition, Expression, Interpolation, Literally
from deros.models.starting import Ready
from deros.models.system import System
from deros.names.graph_names import ANY_ROOT
from deros.systems.arguments.symbolic import SymbolicSystem, joined
from deros.systems.flat import FlatNode, FlatProcess, FlatProgram
from deros.systems.flatten import flatten
from deros.systems.running.starting import Key, key_of

_Form = tuple[FlatNode, Condition | None, Text]
"""A node in one of its forms, the condition of that form, and its full name there."""


class Waits:
    """The nodes of a system that programs may wait for, on whichever host these are."""

    def __init__(self, system: System, root: str) -> None:
        """Find them in a system, not yet placed on a host, that is started in a namespace.

        Raises:
            GenerationError: if the nodes are there in too many ways.
        """
        self._forms: dict[Key, list[_Form]] = defaultdict(list)
        self._processes: dict[str, FlatProgram] = {}
        symbolic = expanded(system, root) if system.is_computed else None
        found = (
            ((each, None) for each in flatten(system, root).parts)
            if symbolic is None
            else ((each.node, each.when) for each in symbolic.nodes)
        )
        for each, when in found:
            self._add(each, when, symbolic)

    def _add(
        self, program: FlatProgram, when: Condition | None, symbolic: SymbolicSystem | None
    ) -> None:
        self._processes[program.full_name] = program
        if isinstance(program, FlatNode):
            name = _from_root(marked_text(program.full_name, symbolic))
            self._forms[key_of(program)].append((program, when, name))
        if not isinstance(program, FlatNode | FlatProcess):
            return
        for node in program.inside:
            self._add(node, when, symbolic)

    def added(
        self,
        view: NodeView | ProcessView,
        program: FlatNode | FlatProcess,
        symbolic: SymbolicSystem | None,
    ) -> NodeView | ProcessView:
        """Return the view of a program with what that waits for.

        Raises:
            GenerationError: if that is a node which is not there.
        """
        ready = view.starting.ready
        if ready is None:
            return view
        if not ready.names_program:
            name = _from_root(marked_text(joined(program.awaited_end), symbolic))
            return replace(view, wait=WaitView(ready, name))
        forms = self._forms_of(program, ready)
        if not forms:
            message = f"there is no node '{ready.name}' that could be waited for"
            raise GenerationError([report(codes.UNKNOWN_AWAITED, message, ready.name_span)])
        processes = [self._process(node) for node, _, _ in forms]
        owners = {None if each is None else "/".join(key_of(each)) for each in processes}
        owner = owners.pop() if len(owners) == 1 else None
        restarts = any(map(_restarts, processes))
        name = _chosen(forms, ready.name_span)
        return replace(view, wait=WaitView(ready, name, owner or "", restarts))

    def _forms_of(self, program: FlatProgram, ready: Ready) -> list[_Form]:
        """Return the forms of the awaited node, the innermost first; the last one is left."""
        found: list[_Form] = []
        for depth in range(len(program.path), -1, -1):
            for form in self._forms.get((*program.path[:depth], *ready.name.split("/")), ()):
                found.append(form)
                if form[1] is None:
                    return found
        return found

    def _process(self, node: FlatNode) -> FlatProgram | None:
        """Return the program in whose process a node is; ``None`` if the system starts none."""
        if node.launch is not None:
            return None
        process = node.container or node.process
        return node if process is None else self._processes.get(process)


def _restarts(program: FlatProgram | None) -> bool:
    return isinstance(program, FlatNode | FlatProcess) and program.instance.respawn is not None


def _from_root(text: Text) -> Text:
    """Return a full name relative to the namespace that the system is started in, if it is so."""
    if isinstance(text, str):
        return text.removeprefix(f"{ANY_ROOT}/")
    first, *others = text.pieces
    if isinstance(first, str):
        first = first.removeprefix(f"{ANY_ROOT}/")
    return replace(text, pieces=tuple(each for each in (first, *others) if each != ""))


def _chosen(forms: list[_Form], place: Span) -> Text:
    """Return the name of the node that is there; that it is one of them has been checked."""
    *others, (_, _, name) = forms
    for _, when, other in reversed(others):
        if other != name:
            assert when is not None  # else it is the last one
            found = Chosen(when, _expression(other, place), _expression(name, place), place)
            name = Computed((found,))
    return name


def _expression(text: Text, place: Span) -> Expression:
    if isinstance(text, str):
        return Literally(text, place)
    if len(text.pieces) == 1 and not isinstance(text.pieces[0], str):
        return text.pieces[0]
    return Interpolation(text.pieces, place)
