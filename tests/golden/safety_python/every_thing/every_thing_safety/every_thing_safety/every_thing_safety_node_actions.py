"""
The actions of every_thing_safety_node: yours to fill in.

deros wrote this file once and leaves it alone. Remove @not_filled_in where you write the code.
"""

from every_thing_safety.every_thing_safety_node_actions_base import (
    EveryThingSafetyNodeActionsBase,
    not_filled_in,
)


class EveryThingSafetyNodeActions(EveryThingSafetyNodeActionsBase):
    """What this robot does when its safety rules say so."""

    def release(self) -> None:
        """
        Carry out the action release.

        Declared in every_thing.deros:6, run by taken_over.

        Running it resets crawl, creep; it need not do anything else.
        """

    @not_filled_in
    def beep(self, times: float, why: str) -> None:
        """
        Carry out the action beep.

        Sounds the horn.

        Declared in every_thing.deros:7, run by speeding, behaviour_3.
        """
