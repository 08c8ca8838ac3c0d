"""The lines of a gate as the steps that they mean.

The lines of a gate mean the following:

* A line applies while its action is active *as far as the gate knows*, or while what it names is
  lost. What the gate does not know counts against the command: an action counts as active before
  the first message about its state, and from a loss of the heartbeat until the next such message.
* The heartbeat, or the input, is lost from the start until it first arrives, and again at the
  instant when it has been silent for the line's time (inclusive). A refused command makes the input
  lost at once, until the next good one.
* A heartbeat is a sign of life if its counter is greater than that of the one before. A heartbeat
  whose counter is not makes the heartbeat lost at once; like the first one, it is what the next one
  is compared with. Where more than one node publishes the heartbeat, nothing is known.
* A state that may come from another node than the safety node makes an action active, never
  inactive.
* For each number of the command, the first line that applies and names it decides; ``zero`` names
  all of them. The limits of an action do not apply while the heartbeat or the input is lost.
* A line with ``zero until reset`` that has applied is *latched* until the gate is reset: every
  number is zero, whether or not the line still applies. A reset is refused, and not remembered,
  while a line with ``zero`` applies or anything is lost.
* With ``resume on zero command``, the gate *waits* from the start, and after each zero line that
  applies or is latched: every number is zero. The wait ends with a good command that is zero and
  arrives while nothing is latched and no zero line applies.
* A good command is published at once, within the limits. While a zero line decides, it is not
  published: zeros are, at once and then with the gate's period, until no zero line decides.
* A limit that starts to apply between two commands is applied to the one being executed: if that
  exceeds it, it is published again within the limits. When a line ends, nothing is published.

Source: docs, "What a gate means".
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence

from deros.interfaces.fields import FieldPath
from deros.interfaces.store import InterfaceStore
from deros.monitor import gate_program as form
from deros.monitor.command_types import CommandType, command_types
from deros.monitor.gate_table import limited_paths
from deros.monitor.ir import Action, Binding, Gate, GateLine


def gate_program(gate: Gate, actions: Sequence[Action], store: InterfaceStore) -> form.GateProgram:
    """Return what a gate does.

    Args:
        gate: the gate.
        actions: those of the rules that it belongs to, by index.
        store: the message definitions.
    """
    return _Lowering(gate, actions).program(command_types(store, gate.type))


class _Lowering:
    """Turns the lines of one gate into steps."""

    def __init__(self, gate: Gate, actions: Sequence[Action]) -> None:
        self._gate = gate
        self._waits = gate.resume_on_zero
        self._lines = tuple(enumerate(gate.lines))
        self._losses = tuple((index, line) for index, line in self._lines if line.lost)
        self._lost = tuple(dict.fromkeys(line.lost for _, line in self._losses if line.lost))
        self._latching = tuple(index for index, line in self._lines if line.until_reset)
        self._releasing = tuple(
            index for index, line in self._lines if not line.limits and not line.until_reset
        )
        self._bindings: dict[str, dict[int, Binding]] = {}
        for line in gate.lines:
            if line.action is not None:
                binding = actions[line.action].binding
                assert binding is not None, actions[line.action].name
                self._bindings.setdefault(binding.topic, {})[line.action] = binding
        self._actions = tuple(index for bound in self._bindings.values() for index in bound)

    def program(self, types: tuple[CommandType, ...]) -> form.GateProgram:
        settle = form.Settle()
        has_input, has_heartbeat = "input" in self._lost, "heartbeat" in self._lost
        assume = (form.AssumeActive(self._actions),) if self._actions else ()
        forget = (form.Forget("heartbeat"),) if has_heartbeat else ()
        return form.GateProgram(
            self._gate,
            types,
            limited_paths(self._gate),
            tuple(self._states()),
            memory=tuple(self._memory()),
            on_command=(
                *([form.NoteInput()] if has_input else []),
                form.StoreCommand(),
                form.Settle(True),
            ),
            on_refused=(form.Forget("input"), settle) if has_input else (),
            on_heartbeat=(form.TakeHeartbeat(), settle) if has_heartbeat else (),
            on_no_safety_node=(*assume, *forget, settle) if assume or forget else (),
            on_reset=(form.Reset(self._refusing(), self._latching),),
            settle=tuple(self._settle()),
        )

    def _states(self) -> Iterator[form.StateTopic]:
        for topic, bound in self._bindings.items():
            yield form.StateTopic(
                topic, tuple(bound.items()), (*map(form.TakeState, bound), form.Settle())
            )

    def _memory(self) -> Iterator[form.Variable]:
        if self._actions:
            yield form.ActionStates(self._actions)
        if "heartbeat" in self._lost:
            yield form.LastSign("heartbeat")
            if self._actions:
                yield form.HeartbeatWasLost()
        if "input" in self._lost:
            yield form.LastSign("input")
        if self._latching:
            yield form.Latches(self._latching)
        if self._waits:
            yield form.Wait()
        yield form.Decision()
        if self._losses:
            yield form.NextLoss()

    def _refusing(self) -> tuple[int, ...]:
        return tuple(index for index, line in self._lines if line.lost or not line.limits)

    # Deciding -----------------------------------------------------------------------------------

    def _settle(self) -> Iterator[form.Step]:
        for index, line in self._losses:
            yield form.FindLine(index, _silent(line))
        publish = self._publish()
        if "input" in self._lost and (publish.unless or self._has_limits_of_actions()):
            yield self._find_loss("input")
        if "heartbeat" in self._lost and self._actions:
            yield self._find_loss("heartbeat")
            yield form.ForgetActions(self._actions)
        for index, line in self._lines:
            if line.action is not None:
                yield form.FindLine(index, self._action_applies(line, line.action))
        if self._latching:
            yield form.LatchLines(self._latching)
        latched = (form.IsAnyLatched(),) if self._latching else ()
        yield form.FindZero(form.AnyOf((*map(form.Applies, self._releasing), *latched)))
        if self._waits:
            yield form.UpdateWait()
        if publish.is_limiting:
            paths = limited_paths(self._gate)
            yield form.ChooseLimits(
                tuple(form.FieldChoice(path, self._choices(path)) for path in paths)
            )
        yield publish
        yield form.ReportApplying(tuple(self._applying()))
        if self._losses:
            yield form.ScheduleLosses(tuple(map(_deadline, self._losses)))

    def _find_loss(self, source: form.Source) -> form.FindLoss:
        return form.FindLoss(source, tuple(i for i, line in self._losses if line.lost == source))

    def _has_limits_of_actions(self) -> bool:
        return any(line.limits and line.action is not None for line in self._gate.lines)

    def _action_applies(self, line: GateLine, action: int) -> form.Condition:
        if line.limits and self._lost:
            return form.AllOf((form.IsActive(action), form.Not(form.IsLost(self._lost))))
        return form.IsActive(action)

    def _choices(self, path: FieldPath) -> tuple[form.Choice, ...]:
        """Return the limits of a field; of those that apply, the first decides.

        Zero lines after the last limit of the field are left out: there is no limit where they
        apply, and none where they do not. So are zero lines that hold every number at zero.
        """
        choices: list[form.Choice] = []
        for index, line in self._lines:
            limits = (each for each in line.limits if each.path == path)
            choices += [form.Choice(form.Applies(index), limit) for limit in limits]
            if not line.limits and not (line.until_reset or self._waits):
                choices.append(form.Choice(form.Applies(index), None))
        while choices[-1].limit is None:
            choices.pop()
        if self._gate.is_holding:
            choices.insert(
                0, form.Choice(form.IsWaiting() if self._waits else form.IsAnyLatched(), None)
            )
        return tuple(choices)

    def _publish(self) -> form.Publish:
        is_limiting = any(line.limits for line in self._gate.lines)
        has_gaps = is_limiting and bool(self._releasing) and not self._waits
        unless = form.IsLost(("input",)) if has_gaps and "input" in self._lost else None
        zero = form.IsWaiting() if self._waits else form.IsZero()
        return form.Publish(zero, is_limiting, has_gaps, unless)

    def _applying(self) -> Iterator[form.Condition]:
        for index, _ in self._lines:
            yield form.Applies(index)
        for index in self._latching:
            yield form.AllOf((form.IsLatched(index), form.Not(form.Applies(index))))
        if self._waits:
            yield form.AllOf((form.IsWaiting(), form.Not(form.IsZero())))


def _silent(line: GateLine) -> form.Silent:
    assert line.lost is not None
    return form.Silent(line.lost, line.lost_ns or 0)


def _deadline(loss: tuple[int, GateLine]) -> form.Deadline:
    index, line = loss
    silent = _silent(line)
    return form.Deadline(index, silent.source, silent.ns)
