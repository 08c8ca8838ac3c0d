"""Checks of what resets an action: whether a button that is held or stuck is enough."""

from __future__ import annotations

import operator
from collections.abc import Callable, Iterator, Mapping, Sequence

from deros import codes
from deros.diagnostics import Diagnostic, report
from deros.models import rules
from deros.rules.functions.reads import term_name
from deros.rules.program import ir, walk
from deros.validators.deciding import Deciding, Node, nodes_in
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
    deciding = Deciding(program)
    losses = _Losses(deciding)
    releases = _Releases(program, deciding, buttons)
    both = zip(behaviours_of(written), walk.behaviours(program), strict=True)
    for source, behaviour in both:
        run = [each.action for each in behaviour.body if isinstance(each, ir.Trigger)]
        for reset in (program.actions[index] for index in dict.fromkeys(run)):
            ended = _reset_by(reset, program, losses)
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
    names = [term_name(program, ir.Read(each.index)) for each in buttons]
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


def _reset_by(reset: ir.Action, program: ir.Program, losses: _Losses) -> list[ir.Action]:
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
    return ended if is_mutual and not losses.trigger(reset) else []


class _Losses:
    """Whether conditions ask for the loss of a sensor, as those of stops do."""

    def __init__(self, deciding: Deciding) -> None:
        self._deciding = deciding
        self._found: dict[Node, bool] = {}

    def trigger(self, action: ir.Action) -> bool:
        """Return whether an action is triggered where a sensor is lost."""
        triggers = self._deciding.triggers(action.index)
        return any(self._are_asked(each.condition) for each in triggers)

    def _are_asked(self, condition: ir.Condition) -> bool:
        for node in self._deciding.behind(condition, self._found):
            self._found[node] = any(map(self._are_asked_in, self._deciding.wholes(node)))
        return self._are_asked_in(condition)

    def _are_asked_in(self, condition: ir.Condition) -> bool:
        asking = ir.Missing | ir.Unknown | ir.Frequency
        itself = any(isinstance(part, asking) for part in walk.parts(condition))
        return itself or any(self._found[node] for node in nodes_in(condition))


# Buttons that are enough ------------------------------------------------------------------------


class _Releases:
    """Finds the buttons that are enough for a behaviour to run a reset."""

    def __init__(self, program: ir.Program, deciding: Deciding, buttons: set[int]) -> None:
        self._program = program
        self._deciding = deciding
        self._signs = _Signs(program, deciding, buttons)
        self._possible: dict[tuple[frozenset[int], _Verdicts, frozenset[int]], _Possible] = {}
        self._stopping: dict[tuple[int, ...], dict[int, list[ir.Condition]]] = {}

    def held(self, behaviour: ir.Behaviour, ended: Sequence[ir.Action]) -> list[int]:
        """Return the buttons that one alternative of a behaviour needs, and not to have seen up."""
        begun = self._begun_with(ended)
        for whole in self._wholes(behaviour, failsafe=False):
            needed = frozenset(
                each for each in self._signs.of(whole)[0] if not self._is_state(each, ended)
            )
            if (
                needed
                and True in self._given(needed, _NEVER_UP, begun).of(whole)
                and True not in self._given(needed, _NEVER_DOWN, begun).of(whole)
            ):
                return sorted(needed)
        return []

    def _begun_with(self, ended: Sequence[ir.Action]) -> frozenset[int]:
        """Return the actions that are triggered wherever one of those that end is."""
        triggers = [set(each.triggered_by) for each in ended if each.triggered_by]
        return frozenset(
            each.index
            for each in self._program.actions
            if any(own.issubset(each.triggered_by) for own in triggers)
        )

    def _wholes(self, behaviour: ir.Behaviour, *, failsafe: bool) -> Iterator[ir.Condition]:
        """Yield the alternatives of a behaviour, each with the conditions around it.

        In the place of the state of an action alone are those of what triggers the action.
        """
        seen: set[int] = set()
        open_ = [behaviour]
        while open_:
            each = open_.pop()
            if each.index in seen:
                continue
            seen.add(each.index)
            around = self._deciding.around(each)
            for part in _alternatives(each.condition, self._program, failsafe=failsafe):
                if isinstance(part, ir.Active) and not around:
                    open_ += reversed(self._deciding.triggers(part.action))
                else:
                    yield ir.And((*around, part)) if around else part

    def _given(
        self, buttons: frozenset[int], verdicts: _Verdicts, begun: frozenset[int] = frozenset()
    ) -> _Possible:
        key = buttons, verdicts, begun
        if key not in self._possible:
            fields = dict.fromkeys(buttons, verdicts)
            self._possible[key] = _Possible(self._program, self._deciding, fields, begun)
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
        triggers = {each.index: each for a in ended for each in self._deciding.triggers(a.index)}
        for _, behaviour in sorted(triggers.items()):
            for whole in self._wholes(behaviour, failsafe=True):
                for leaf in self._signs.of(whole)[1]:
                    found.setdefault(leaf, []).append(whole)
        return found

    def _remembers(self, whole: ir.Condition) -> bool:
        """Return whether a condition has a ``since`` or asks for an action, by names of rules too.

        Both last when what began them is over.
        """
        wholes = walk.with_named(whole, self._program.rules)
        memory = ir.Since | ir.Active
        return any(isinstance(part, memory) for each in wholes for part in walk.parts(each))


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
    """The buttons that conditions read, through the names of rules and the states of actions."""

    def __init__(self, program: ir.Program, deciding: Deciding, buttons: set[int]) -> None:
        self._program = program
        self._deciding = deciding
        self._buttons = buttons
        self._found: dict[Node, _Signed] = {}

    def of(self, condition: ir.Condition) -> _Signed:
        """Return those of a condition; one may be among both."""
        for node in self._deciding.behind(condition, self._found):
            self._found[node] = self._of_node(*node)
        return self._of(condition)

    def _of_node(self, kind: str, index: int) -> _Signed:
        if kind == "rule":
            return self._of(self._program.rules[index].condition)
        whole = self._deciding.whole
        signed = [self._of(whole(each)) for each in self._deciding.triggers(index)]
        # What resets an action counts the other way round.
        signed += [self._of(whole(each))[::-1] for each in self._deciding.resets(index)]
        none = frozenset[int]()
        return none.union(*(each for each, _ in signed)), none.union(*(each for _, each in signed))

    def _of(self, condition: ir.Condition) -> _Signed:
        down: set[int] = set()
        up: set[int] = set()
        open_ = [(condition, False)]
        while open_:
            part, negated = open_.pop()
            inner = walk.operands(part)
            open_ += [(each, negated ^ isinstance(part, ir.Not)) for each in inner]
            if inner:
                continue
            found = self._found[nodes[0]] if (nodes := nodes_in(part)) else self._compared(part)
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
                _Possible(
                    self._program, self._deciding, {leaf: frozenset({verdict})}, frozenset()
                ).of(condition)
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

    def __init__(
        self,
        program: ir.Program,
        deciding: Deciding,
        fields: Mapping[int, _Verdicts],
        begun: frozenset[int],
    ) -> None:
        """Take the verdicts of fields, and the actions that have been triggered."""
        self._program = program
        self._deciding = deciding
        self._fields = fields
        self._begun = begun
        self._found: dict[Node, _Verdicts] = {}

    def of(self, condition: ir.Condition) -> _Verdicts:
        """Return the verdicts of a condition."""
        for node in self._deciding.behind(condition, self._found):
            self._found[node] = self._of_node(*node)
        return self._of(condition)

    def _of_node(self, kind: str, index: int) -> _Verdicts:
        if kind == "rule":
            return self._of(self._program.rules[index].condition)
        action = self._program.actions[index]
        lasts = index in self._begun and action.reset_by is not None
        starts = self._may_run(self._deciding.triggers(index))
        ends = not lasts or self._may_run(self._deciding.resets(index))
        return frozenset({*({True} if starts else ()), *({False} if ends else ())})

    def _may_run(self, behaviours: list[ir.Behaviour]) -> bool:
        return any(True in self._of(self._deciding.whole(each)) for each in behaviours)

    def _of(self, condition: ir.Condition) -> _Verdicts:
        match condition:
            case ir.RuleRef() | ir.Active():
                return self._found[nodes_in(condition)[0]]
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
