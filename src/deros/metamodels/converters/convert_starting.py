"""When and where programs are started, and what follows their end."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

from deros import codes
from deros.metamodels.converters.convert_arguments import ArgumentConverter
from deros.models.common import Name
from deros.models.starting import AT_ONCE, READY_TIMEOUT_NS, After, Delay, Host, Ready, Starting
from deros.models.system import NodeInstance

STARTING_WORDS = {
    "StartDelay": "delay",
    "After": "after",
    "OnExit": "on exit",
    "OnHost": "on",
}
"""The modifiers of what is started later, elsewhere, or ends the system, by their rules."""
OF_STARTERS = {
    "Respawn": "respawn",
    "LogLevel": "log_level",
    "Autostart": "autostart",
    "ProgramArguments": "arguments",
    "Variable": "env",
    "Prefix": "prefix",
    "OwnName": "own_name",
    **STARTING_WORDS,
}
"""The modifiers that say how a node is started, by their rules."""


def not_started(node: NodeInstance) -> NodeInstance:
    """Return a node without what :data:`OF_STARTERS` say, so that nothing follows from it."""
    return replace(
        node,
        respawn=None,
        log_level=None,
        autostart=None,
        arguments=(),
        environment=(),
        prefix=None,
        own_name=None,
        starting=AT_ONCE,
        host=None,
    )


class StartingConverter(ArgumentConverter):
    """Converts hosts, ``delay``, ``after`` and ``on exit stop all``."""

    def starting(self, modifiers: Any) -> dict[str, Any]:
        """Return the fields that the modifiers of a program or a group set, if they do.

        ``delay`` behind ``respawn`` is refused: there, it reads like the one of restarts.
        """
        fields: dict[str, Any] = {}
        found = AT_ONCE
        behind_respawn = False
        for modifier in modifiers:
            kind = type(modifier).__name__
            behind_respawn |= kind == "Respawn"
            if kind == "StartDelay" and found.delay is None:
                found = replace(found, delay=self._delay(modifier, behind_respawn))
            elif kind == "After" and found.after is None and found.ready is None:
                found = self._waiting(found, modifier)
            elif kind == "OnExit":
                found = replace(found, stops_all=self.span(modifier))
            elif kind == "OnHost" and "host" not in fields:
                fields["host"] = Name(str(modifier.host), self.token_span(modifier.host))
        if found != Starting():
            fields["starting"] = found
        return fields

    def host(self, found: Any) -> Host:
        """Return a computer of the system."""
        address, address_from = self.computed_name(found.address)
        setup, setup_from = self.computed_name(found.setup) if found.setup else ("", None)
        return Host(
            str(found.name),
            address,
            self.span(found),
            self.token_span(found.name),
            self.text(found.description) if found.description else "",
            address_from,
            setup,
            setup_from,
        )

    def _waiting(self, starting: Starting, modifier: Any) -> Starting:
        if not modifier.kind:
            place = self.token_span(modifier.awaited)
            after = After(str(modifier.awaited), self.span(modifier), place)
            return replace(starting, after=after)
        timeout_ns = READY_TIMEOUT_NS
        if modifier.timeout is not None:
            timeout_ns = self.positive_ns(modifier.timeout, "the timeout of a start")
            self.check_longest(timeout_ns, "a timeout", modifier.timeout)
        token = modifier.awaited or modifier.target
        name, name_from = str(token), None
        if modifier.target:
            name, name_from = self.computed_name(token)
        kind: Any = str(modifier.kind)
        place = self.token_span(token)
        ready = Ready(kind, name, timeout_ns, self.span(modifier), place, name_from)
        return replace(starting, ready=ready)

    def _delay(self, modifier: Any, behind_respawn: bool) -> Delay:
        ns = self.positive_ns(modifier.delay, "the delay of a start")
        self.check_longest(ns, "a delay", modifier.delay)
        if behind_respawn:
            self.report(
                codes.SYNTAX_ERROR,
                "this delays the first start, and reads like a delay of restarts",
                self.span(modifier),
                "write it before 'respawn'; a delay of restarts follows the word:"
                " 'respawn delay T max N'",
            )
        return Delay(ns, self.span(modifier))
