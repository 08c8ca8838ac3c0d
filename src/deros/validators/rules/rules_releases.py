"""Checks of what resets an action: whether a button that is held or stuck is enough."""

from __future__ import annotations

import operator
from collections.abc import Callable, Iterator, Mapping, Sequence

from deros import codes
from deros.diagnostics import Diagnostic, report
from deros.interfaces.fields import format_steps
from deros.models import rules
from deros.rules.program import ir, walk
from deros.validators.rules_walk import behaviours_of

_Verdicts = frozenset[bool | None]
"""Some of Kleene's three values; ``None`` is unknown."""

_ANY: _Verdicts = frozenset({True, False, None})
_KNOWN: _Verdicts = frozenset({True, False})
_NEVER_UP: _Verdicts = frozenset({True, None})
_NEVER_DOWN: _Verdicts = frozenset({False, None})

_OPERATORS: dict[ir.Operator, Callable[[object, object], bool]] = {
    "=": operator.eq,
    "!=": operator.ne,
}


def check_releases(written: rules.Rules, program: ir.Program) -> Iterator[Diagnostic]:
    """Yield one finding per behaviour that resets an action because a button is down.

    It needs the button, and does not need to have seen it up. What stops the robot while it is
    false, such as a key that enables it, is a state and not a button.
    """
    buttons = {leaf.index for leaf in program.leaves if _is_button(leaf, program)}
    if not buttons:
        return
    releases = _Releases(program, buttons)
    both = zip(behaviours_of(written), walk.behaviours(program), strict=True)
    for source, behaviour in both:
        run = [each.action for each in behaviour.body if isinstance(each, ir.Trigger)]
        for reset in (program.actions[index] for index in dict.fromkeys(run)):
            ended = _reset_by(reset, program)
            found = releases.held(behaviour, ended) if ended else []
            if found:
                yield _finding(
                    source, reset, ended, [program.leaves[each] for each in found], program
                )


def _finding(
    source: rules.Behaviour,
    reset: ir.Action,
    ended: list[ir.Action],
    buttons: list[ir.Leaf],
    program: ir.Program,
) -> Diagnostic:
    names = [_name(each, program) for each in buttons]
    listed = ", ".join(f"'{each.name}'" for each in ended)
    if len(names) == 1:
        down, up = f"{names[0]}", f"not {names[0]}"
        if buttons[0].type.base != "bool":
            down, up = f"{names[0]} = 1", f"{names[0]} = 0"
        hint = f"write '{down} begins and (up within 1 ms)', with a rule 'up: ({up}) for 0.1 sec'"
    else:
        hint = "ask for presses that were seen: each 'begins', and was up just before"
    held = " and ".join(f"'{each}'" for each in names)
    return report(
        codes.RESET_BY_HELD_BUTTON,
        f"{held} held or stuck {'is' if len(names) == 1 else 'are'} enough for '{reset.name}',"
        f" which resets {listed}: nothing asks for a press that was seen",
        source.condition.span,
        hint,
    )


def _is_button(leaf: ir.Leaf, program: ir.Program) -> bool:
    """Return whether a field is true while a button is down: a boolean, or one of a joystick."""
    if leaf.type.is_array:
        return False
    of_joystick = str(program.inputs[leaf.input].type) == "sensor_msgs/msg/Joy"
    return leaf.type.base == "bool" or (of_joystick and leaf.path[0] == "buttons")


def _name(leaf: ir.Leaf, program: ir.Program) -> str:
    """Return how rules name a field."""
    owner = program.inputs[leaf.input]
    return owner.name + format_steps(leaf.path[len(owner.path) :])


def _reset_by(reset: ir.Action, program: ir.Program) -> list[ir.Action]:
    """Return the actions that one resets, if it permits something.

    One that stops the robot may reset others as well, such as the permission to drive or a lesser
    stop. It has a reset of its own, or a gate acts on it.
    """
    ended = [each for each in program.actions if each.reset_by == reset.index]
    ended = [each for each in ended if each is not reset]
    acts = any(line.action == reset.index for gate in program.gates for line in gate.lines)
    if not ended or acts or reset.latched:
        return []
    if reset.reset_by is None:
        return ended
    is_mutual = any(each.index == reset.reset_by for each in ended)
    return ended if is_mutual and not _acts_on_loss(reset, program) else []


def _acts_on_loss(action: ir.Action, program: ir.Program) -> bool:
    """Return whether an action is triggered where a sensor is lost, as stops are."""
    return any(
        isinstance(part, ir.Missing | ir.Unknown | ir.Frequency)
        for behaviour in walk.behaviours(program)
        if behaviour.index in action.triggered_by
        for whole in walk.with_named(behaviour.condition, program.rules)
        for part in walk.parts(whole)
    )


# Buttons that are enough ------------------------------------------------------------------------


class _Releases:
    """Finds the buttons that are enough for a behaviour to run a reset."""

    def __init__(self, program: ir.Program, buttons: set[int]) -> None:
        self._program = program
        self._owners = {each.index: each for each in walk.behaviours(program)}
        self._signs = _Signs(program, buttons)
        self._possible: dict[tuple[frozenset[int], _Verdicts], _Possible] = {}
        self._stopping: dict[tuple[int, ...], dict[int, list[ir.Condition]]] = {}

    def held(self, behaviour: ir.Behaviour, ended: Sequence[ir.Action]) -> list[int]:
        """Return the buttons that one alternative of a behaviour needs, and not to have seen up."""
        for whole in self._wholes(behaviour, failsafe=False):
            needed = frozenset(
                each for each in self._signs.of(whole)[0] if not self._is_state(each, ended)
            )
            if (
                needed
                and True in self._given(needed, _NEVER_UP).of(whole)
                and True not in self._given(needed, _NEVER_DOWN).of(whole)
            ):
                return sorted(needed)
        return []

    def _wholes(self, behaviour: ir.Behaviour, *, failsafe: bool) -> Iterator[ir.Condition]:
        """Yield the alternatives of a behaviour, each with the conditions around it."""
        around: list[ir.Condition] = []
        parent = behaviour.parent
        while parent is not None:
            around.append(self._owners[parent].condition)
            parent = self._owners[parent].parent
        for each in _alternatives(behaviour.condition, self._program, failsafe=failsafe):
            yield ir.And((*around, each)) if around else each

    def _given(self, buttons: frozenset[int], verdicts: _Verdicts) -> _Possible:
        key = buttons, verdicts
        if key not in self._possible:
            self._possible[key] = _Possible(self._program, dict.fromkeys(buttons, verdicts))
        return self._possible[key]

    def _is_state(self, leaf: int, ended: Sequence[ir.Action]) -> bool:
        """Return whether a trigger of what is reset is that a boolean is false, now."""
        key = tuple(each.index for each in ended)
        if key not in self._stopping:
            self._stopping[key] = self._triggers(ended)
        this = frozenset({leaf})
        return any(
            True not in self._given(this, frozenset({True})).of(whole)
            and True in self._given(this, frozenset({False})).of(whole)
            and not self._remembers(whole)
            for whole in self._stopping[key].get(leaf, ())
        )

    def _triggers(self, ended: Sequence[ir.Action]) -> dict[int, list[ir.Condition]]:
        """Return what triggers actions, by the buttons that have to be up for it."""
        found: dict[int, list[ir.Condition]] = {}
        for index in sorted({each for action in ended for each in action.triggered_by}):
            for whole in self._wholes(self._owners[index], failsafe=True):
                for leaf in self._signs.of(whole)[1]:
                    found.setdefault(leaf, []).append(whole)
        return found

    def _remembers(self, whole: ir.Condition) -> bool:
        """Return whether a condition has a ``since``, by itself or by a rule that it names."""
        wholes = walk.with_named(whole, self._program.rules)
        return any(isinstance(part, ir.Since) for each in wholes for part in walk.parts(each))


def _alternatives(
    condition: ir.Condition, program: ir.Program, *, failsafe: bool
) -> Iterator[ir.Condition]:
    """Yield the conditions of which one is enough, through names and, if asked, ``failsafe``."""
    seen: set[int] = set()
    open_ = [condition]
    while open_:
        match part := open_.pop():
            case ir.Or():
                open_ += reversed(part.operands)
            case ir.RuleRef(rule=rule):
                if rule not in seen:
                    seen.add(rule)
                    open_.append(program.rules[rule].condition)
            case ir.Failsafe() if failsafe:
                open_.append(part.operand)
            case _:
                yield part


_Signed = tuple[frozenset[int], frozenset[int]]
"""The buttons of which a condition needs somewhere that they are down, and that they are up."""


class _Signs:
    """The buttons that conditions read, through the names of rules."""

    def __init__(self, program: ir.Program, buttons: set[int]) -> None:
        self._program = program
        self._buttons = buttons
        self._rules: list[_Signed] = []
        for rule in program.rules:  # after those that it names
            self._rules.append(self.of(rule.condition))

    def of(self, condition: ir.Condition) -> _Signed:
        """Return those of a condition; one may be among both."""
        down: set[int] = set()
        up: set[int] = set()
        open_ = [(condition, False)]
        while open_:
            part, negated = open_.pop()
            inner = walk.operands(part)
            open_ += [(each, negated ^ isinstance(part, ir.Not)) for each in inner]
            if inner:
                continue
            found = self._rules[part.rule] if isinstance(part, ir.RuleRef) else self._compared(part)
            for mine, other in zip((down, up), reversed(found) if negated else found, strict=True):
                mine |= other
        return frozenset(down), frozenset(up)

    def _compared(self, condition: ir.Condition) -> _Signed:
        """Return those that a condition without operands compares."""
        down: set[int] = set()
        up: set[int] = set()
        read = {leaf for value in walk.values([condition]) for leaf in walk.leaves(value)}
        for leaf in read & self._buttons:
            if_down, if_up = (
                _Possible(self._program, {leaf: frozenset({verdict})}).of(condition)
                for verdict in (True, False)
            )
            if True in if_down and True not in if_up:
                down.add(leaf)
            if True in if_up and True not in if_down:
                up.add(leaf)
        return frozenset(down), frozenset(up)


class _Possible:
    """The verdicts that conditions may have while some fields have certain values only.

    A verdict that is left out is impossible; one that is there may be impossible as well.
    """

    def __init__(self, program: ir.Program, fields: Mapping[int, _Verdicts]) -> None:
        self._program = program
        self._fields = fields
        self._rules: dict[int, _Verdicts] = {}

    def of(self, condition: ir.Condition) -> _Verdicts:
        """Return the verdicts of a condition."""
        open_ = [each for each in walk.rules_in(condition) if each not in self._rules]
        while open_:
            found = self._program.rules[open_[-1]].condition
            waiting = [each for each in walk.rules_in(found) if each not in self._rules]
            if waiting:
                open_ += waiting
            else:
                self._rules.setdefault(open_.pop(), self._of(found))
        return self._of(condition)

    def _of(self, condition: ir.Condition) -> _Verdicts:
        match condition:
            case ir.RuleRef(rule=rule):
                return self._rules[rule]
            case ir.Truth(operand=operand):
                return self._values(operand)
            case ir.Compare():
                return self._compared(condition)
            case ir.Missing() | ir.Unknown() | ir.Frequency():
                return _KNOWN
            case ir.Not(operand=operand):
                return frozenset(None if each is None else not each for each in self._of(operand))
            case ir.And() | ir.Or():
                return self._together(condition)
            case ir.Once(operand=operand):
                return self._of(operand)
            case ir.Times(operand=operand):
                return _KNOWN | (self._of(operand) & {None})
            case ir.For(operand=operand):
                found = self._of(operand)
                return found | {False} if True in found else found
            case ir.Begins(operand=operand):
                return self._of(operand.operand) | {False}
            case ir.Since(operand=operand, cause=cause):
                began = self._of(cause)
                return began | (self._of(operand) & {None})
            case ir.Failsafe(operand=operand):
                found = self._of(operand)
                return found | {True} if None in found else found
            case _:
                return _ANY

    def _together(self, condition: ir.And | ir.Or) -> _Verdicts:
        absorbing = isinstance(condition, ir.Or)
        every = [self._of(each) for each in condition.operands]
        found = {absorbing} if any(absorbing in each for each in every) else set[bool | None]()
        found |= {not absorbing} if all((not absorbing) in each for each in every) else set()
        open_ = any(None in each for each in every)
        undecided = all(each & {None, not absorbing} for each in every)
        return frozenset(found | ({None} if open_ and undecided else set()))

    def _compared(self, condition: ir.Compare) -> _Verdicts:
        compare = _OPERATORS.get(condition.operator)
        if compare is None:
            return _ANY
        left, right = self._values(condition.left), self._values(condition.right)
        return frozenset(
            None if one is None or other is None else compare(one, other)
            for one in left
            for other in right
        )

    def _values(self, value: ir.ValueExpression) -> _Verdicts:
        """Return the values of a boolean, or 0 and 1 of a joystick, as booleans."""
        match value:
            case ir.Read(leaf=leaf):
                return self._fields.get(leaf, _ANY)
            case ir.Apply(function="previous", arguments=(operand, *_)):
                return self._values(operand) | {None}
            case ir.Const(value=bool() | 0 | 1 as constant):
                return frozenset({bool(constant)})
            case _:
                return _ANY
