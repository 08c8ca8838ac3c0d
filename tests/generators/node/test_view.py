"""Name collisions within a node, in any language."""

from __future__ import annotations

import re

import pytest

from deros.generators.api.protocol import GenerateFunction
from tests.support.node_targets import files_of, in_each_language, refusal


@in_each_language
@pytest.mark.parametrize(
    ("sections", "method"),
    [
        ("subscribes topic a/b : std_msgs.Bool\ntopic a_b : std_msgs.Bool", "on_a_b"),
        ("publishes topic ~/x : std_msgs.Bool\ntopic /x : std_msgs.Bool", "publish_x"),
        ("subscribes topic tick : std_msgs.Bool timers\ntimer tick every 1 s", "on_tick"),
        ("timers\ntimer parameters_changed every 1 s", "on_parameters_changed"),
        ("lifecycle timers\ntimer activate every 1 s", "on_activate"),
        ("publishes topic a : a_msgs.C\ntopic /b/c : a_msgs.C topic b_c : a_msgs.C", "publish_b_c"),
    ],
)
def test_two_ports_of_one_method_collide(
    sections: str, method: str, generate: GenerateFunction
) -> None:
    """The second place is reported."""
    code, message, line = refusal(generate, f"node a : b {sections}")
    assert (code, line) == ("DRS401", 2)
    assert repr(method) in message


@in_each_language
def test_ports_of_all_kinds_may_have_one_name(generate: GenerateFunction) -> None:
    """Their methods differ; of two clients, the one of the action has a longer name."""
    node = """node a : b
        publishes topic x : std_msgs.Bool
        subscribes topic x : std_msgs.Bool
        services service x : std_srvs.Empty
        clients client x : std_srvs.Empty
        actions action x : test_msgs.Fibonacci
        action_clients action x : test_msgs.Fibonacci
    """
    texts = [file.text for path, file in files_of(generate, node).items() if "a_base" in path]
    methods = "publish_x on_x handle_x call_x accept_x execute_x cancel_x send_x"
    for name in (*methods.split(), "client_x", "action_client_x"):
        assert any(re.search(rf"\b{name}_?\b", text) for text in texts), name


@in_each_language
@pytest.mark.parametrize(
    ("parameters", "name"),
    [
        ("name gains.<j>.p : int = 1\nname gains : int = 1", "gains"),
        ("name g.<j>.p.q : int = 1\nname g.<j>.p_q : int = 1", "p_q"),
        ("name a_b.<j>.p : int = 1\nname a.b.<j>.p : int = 1", "a_b"),
    ],
)
def test_maps_and_their_values_collide_like_parameters(
    parameters: str, name: str, generate: GenerateFunction
) -> None:
    """A map is a field too, and so is each part of its values."""
    text = f"node a : b parameters name j : string[] = [] {parameters}"
    code, message, _ = refusal(generate, text)
    assert code == "DRS401"
    assert repr(name) in message


@in_each_language
@pytest.mark.parametrize(("one", "other"), [("pid.p", "pid_p"), ("class", "class_")])
def test_parameters_of_one_field_collide(one: str, other: str, generate: GenerateFunction) -> None:
    """Different names may have the same spelling in a target language."""
    code, message, line = refusal(
        generate, f"node a : b parameters\nname {one} : double = 1.0\nname {other} : double = 1.0"
    )
    assert (code, line) == ("DRS401", 3)
    assert repr(other) in message
