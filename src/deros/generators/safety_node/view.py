"""The view of a safety node in every language: its states, actions and behaviours."""

from __future__ import annotations

import re
from collections.abc import Iterator
from dataclasses import dataclass

from deros.generators.text.identifiers import file_label
from deros.generators.text.prose import printable_line, sentence
from deros.generators.text.provenance import header, origin
from deros.models.rules import Rules
from deros.rules.compiler.actions import LOG_STATE
from deros.rules.compiler.scope.topics import SystemTopics, declared_shared
from deros.rules.program import walk
from deros.rules.program.ir import Action, Binding, Program, RuleRef, Trigger

_COMMENT = re.compile(r"//[^\n]*|/\*.*?\*/", re.DOTALL)
_CONDITION = re.compile(r"\bif\b(.*?)\bthen\b", re.DOTALL)
_SHARED_BY_CONVENTION = frozenset(
    {"/diagnostics", "/parameter_events", "/rosout", "/tf", "/tf_static"}
)


def origin_file(model: Rules) -> str:
    """Return the file name of the rules; without the folder, output is the same everywhere."""
    return file_label(model.source.path)


# States out ---------------------------------------------------------------------------------------


@dataclass(frozen=True, slots=True)
class FieldView:
    """A field that carries states: the actions, as the code names them, each with its value.

    ``single`` is a boolean field of one action, written without a choice; ``inactive`` what the
    field is set to while none is active, if it has to be.
    """

    target: str
    inactive: str | None
    single: str | None
    states: tuple[tuple[str, str], ...]


@dataclass(frozen=True, slots=True)
class ChannelView:
    """A topic that carries the states of bound ``actions``, as the code names them."""

    identifier: str
    type: str
    topic: str
    actions: tuple[str, ...]
    stamped: bool
    fields: tuple[FieldView, ...]


def states_by_path(
    program: Program, topic: str
) -> dict[tuple[str, ...], list[tuple[Action, Binding]]]:
    """Return the actions whose states a topic carries, by the paths of the fields they are in."""
    by_path: dict[tuple[str, ...], list[tuple[Action, Binding]]] = {}
    for action in program.actions:
        if action.binding is not None and action.binding.topic == topic:
            by_path.setdefault(action.binding.path, []).append((action, action.binding))
    return by_path


# Actions ------------------------------------------------------------------------------------------


def shared_topics(model: Rules, program: Program, topics: SystemTopics) -> frozenset[str]:
    """Return the watched topics that may have more than one publisher.

    Several nodes publish some topics by convention, and others because an input or the topic is
    declared with ``publishers any``. That a system has two publishers of a topic is no such word:
    they may be meant to be one.
    """
    watched = {each.topic for each in program.inputs}
    return frozenset(watched & (_SHARED_BY_CONVENTION | declared_shared(model, topics)))


def needs_code(action: Action) -> bool:
    """Return whether an action is robot code."""
    return not action.is_bound and action.name != LOG_STATE


def only_resets(action: Action, program: Program) -> bool:
    """Return whether the only purpose of an action is to reset others.

    It may have code all the same, but need not. An action with parameters, or with a state of its
    own, has another purpose, too.
    """
    resets = any(other.reset_by == action.index for other in program.actions)
    return resets and needs_code(action) and not lasts(action) and not action.parameters


def lasts(action: Action) -> bool:
    """Return whether an action has a state, and is not just run."""
    return action.is_bound or action.latched or action.reset_by is not None


def refusing_behaviours(action: Action) -> tuple[int, ...]:
    """Return the behaviours, by index, that keep an action from being reset while they hold."""
    return action.triggered_by if action.latched or action.reset_by is not None else ()


def calls(program: Program) -> list[Trigger]:
    """Return the calls of actions, top to bottom."""
    return [
        item
        for behaviour in walk.behaviours(program)
        for item in behaviour.body
        if isinstance(item, Trigger)
    ]


def action_notes(action: Action, program: Program, description: str) -> list[str]:
    """Return the notes for the stub of an action: its purpose, and the behaviours that run it."""
    callers = [b.name for b in walk.behaviours(program) if b.index in action.triggered_by]
    place = f"Declared in {origin(action.span)}" if action.span else "Declared"
    note = f"{place}, run by {', '.join(callers) if callers else 'no behaviour'}."
    notes = [text for text in (sentence(description), note) if text]
    if only_resets(action, program):
        reset = [other.name for other in program.actions if other.reset_by == action.index]
        notes.append(f"Running it resets {', '.join(reset)}; it need not do anything else.")
    return notes


def argument_types(action: Action, program: Program) -> list[dict[str, Trigger]]:
    """Return, for each parameter, the types of the arguments given for it, each with a call.

    An ``int`` given where other calls give a ``float`` is one, too.
    """
    given = [call for call in calls(program) if call.action == action.index]
    found = [
        {type(call.arguments[place]).__name__: call for call in given}
        for place in range(len(action.parameters))
    ]
    for types in found:
        if "float" in types:
            types.pop("int", None)
    return found


# Behaviours ---------------------------------------------------------------------------------------


@dataclass(frozen=True, slots=True)
class BehaviourView:
    """A behaviour, for the reports.

    Attributes:
        origin: file and line.
        condition: as written, on one line.
        rules: those that it depends on, also through the behaviours around it.
    """

    name: str
    origin: str
    condition: str
    rules: tuple[str, ...]


def behaviour_views(program: Program) -> Iterator[BehaviourView]:
    """Yield the views of the behaviours, from top to bottom."""
    rules: dict[int, tuple[str, ...]] = {}
    for each in walk.behaviours(program):
        around = rules[each.parent] if each.parent is not None else ()
        own = (
            program.rules[part.rule].full_name
            for part in walk.parts(each.condition)
            if isinstance(part, RuleRef)
        )
        rules[each.index] = tuple(dict.fromkeys((*around, *own)))
        text = _COMMENT.sub(" ", header(each.span.text))
        condition = _CONDITION.search(text)
        shown = printable_line(condition[1] if condition else text)
        yield BehaviourView(each.name, origin(each.span), shown, rules[each.index])
