"""The bring-up of managed nodes."""

from __future__ import annotations

from typing import Any, cast

from deros import codes
from deros.metamodels.converters.convert_arguments import ArgumentConverter
from deros.models.lifecycle import Autostart, OnFailure


class LifecycleConverter(ArgumentConverter):
    """Converts ``autostart``."""

    def autostart(self, found: Any) -> Autostart:
        """Return how managed nodes are brought to active."""
        timeout = None if found.timeout is None else self.duration_ns(found.timeout)
        if timeout is not None:
            self.check_longest(timeout, "a timeout", found.timeout)
            if timeout <= 0:
                message = "the timeout of transitions must be positive"
                self.report(codes.BAD_DURATION, message, self.span(found.timeout))
        policy = None if found.policy is None else cast(OnFailure, str(found.policy))
        return Autostart(self.span(found), timeout, policy)
