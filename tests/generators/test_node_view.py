"""Which names of a node collide, whatever its language."""

from __future__ import annotations

import pytest

from deros.generators.protocol import GenerateFunction
from tests.support.node_targets import in_each_language, refusal


@in_each_language
@pytest.mark.parametrize(
    ("sections", "method"),
    [
        ("subscribes topic a/b : std_msgs.Bool\ntopic a_b : std_msgs.Bool", "on_a_b"),
        ("publishes topic ~/x : std_msgs.Bool\ntopic /x : std_msgs.Bool", "publish_x"),
        ("subscribes topic tick : std_msgs.Bool timers\ntimer tick every 1 s", "on_tick"),
        ("timers\ntimer parameters_changed every 1 s", "on_parameters_changed"),
        ("lifecycle timers\ntimer activate every 1 s", "on_activate"),
        ("clients client c : std_srvs.Empty action_clients\naction c : a_msgs.C", "client_c"),
    ],
)
def test_two_things_of_one_name_collide(
    sections: str, method: str, generate: GenerateFunction
) -> None:
    """Whatever becomes one method is refused at the second place."""
    code, message, line = refusal(generate, f"node a : b {sections}")
    assert (code, line) == ("DRS401", 2)
    assert repr(method) in message


@in_each_language
@pytest.mark.parametrize(("one", "other"), [("pid.p", "pid_p"), ("class", "class_")])
def test_parameters_of_one_field_collide(one: str, other: str, generate: GenerateFunction) -> None:
    """Names that a language can only hold in one spelling may meet in one field."""
    code, message, line = refusal(
        generate, f"node a : b parameters\nname {one} : double = 1.0\nname {other} : double = 1.0"
    )
    assert (code, line) == ("DRS401", 3)
    assert repr(other) in message
