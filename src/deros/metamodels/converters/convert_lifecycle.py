"""The bring-up of managed nodes."""

from __future__ import annotations

from typing import Any, cast

from deros.metamodels.converters.convert_arguments import ArgumentConverter
from deros.models.lifecycle import Autostart, OnFailure


class LifecycleConverter(ArgumentConverter):
    """Converts ``autostart``."""

    def autostart(self, found: Any) -> Autostart:
        """Return how managed nodes are brought to active."""
        timeout = None
        if found.timeout is not None:
            timeout = self.positive_ns(found.timeout, "the timeout of transitions")
            self.check_longest(timeout, "a timeout", found.timeout)
        policy = None if found.policy is None else cast(OnFailure, str(found.policy))
        return Autostart(self.span(found), timeout, policy)
