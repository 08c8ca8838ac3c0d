"""
The actions of two_rules_safety_node: yours to fill in.

deros wrote this file once and leaves it alone. Remove @not_filled_in where you write the code.
"""

from two_rules_safety.two_rules_safety_node_actions_base import (
    not_filled_in,
    TwoRulesSafetyNodeActionsBase,
)


class TwoRulesSafetyNodeActions(TwoRulesSafetyNodeActionsBase):
    """What this robot does when its safety rules say so."""

    @not_filled_in
    def stop(self) -> None:
        """
        Carry out the action stop.

        Declared in two_rules.deros:2, run by behaviour_1, behaviour_2.
        """
