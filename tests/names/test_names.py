"""Similar names, and the names that ROS 2 accepts."""

from __future__ import annotations

import pytest
from hypothesis import assume, given
from hypothesis import strategies as st

from deros.names.names import (
    check_namespace,
    check_node_name,
    check_package_name,
    check_parameter_name,
    check_timer_name,
    check_topic_name,
    did_you_mean,
    near,
    near_any,
)

names = st.text(alphabet="aB1_/~.- {ü", max_size=12)


def test_near_lists_the_best_match_first() -> None:
    """Typos and case are tolerated; the name itself is not suggested."""
    assert near("lineer", ["angular", "linear", "x"]) == ["linear"]
    assert near("bool", ["Bool", "Boot", "Int8"])[0] == "Bool"
    assert near("speed", ["speed", "speeds"]) == ["speeds"]
    assert near("x", ["yyyy"]) == []
    assert len(near("aaaa", [f"aaa{i}" for i in range(9)])) == 3


def test_near_finds_a_match_among_ten_thousand() -> None:
    """Filtering the topics of a large system does not lose the right one."""
    topics = [f"/group_{i // 10}/topic_{i}" for i in range(10_000)]
    assert near("/group_12/topik_123", topics)[0] == "/group_12/topic_123"
    assert near("/gruop_999/topic_9991", topics)[0] == "/group_999/topic_9991"


@pytest.mark.parametrize(
    ("matches", "text"),
    [
        ([], ""),
        (["a"], "did you mean 'a'?"),
        (["a", "b"], "did you mean 'a' or 'b'?"),
        (["a", "b", "c"], "did you mean 'a', 'b' or 'c'?"),
    ],
)
def test_hints_are_phrased_as_a_question(matches: list[str], text: str) -> None:
    """No matches give no hint."""
    assert did_you_mean(matches) == text


@given(names)
def test_node_name_check_agrees_with_rmw(name: str) -> None:
    """The rule for node names is that of ROS 2."""
    validation = pytest.importorskip("rclpy.validate_node_name")
    assert (check_node_name(name) is None) == _accepted(validation.validate_node_name, name)


@given(names)
def test_topic_name_check_agrees_with_rcl(name: str) -> None:
    """The rule for topic names is that of ROS 2, except for substitutions in braces."""
    assume(not (len(name) == 2 and name[0] == "~"))  # rcl accepts '~x', but not '~xy'
    assume("//" not in name)  # rejected only later, by rmw, when the full name is known
    validation = pytest.importorskip("rclpy.validate_topic_name")
    assert (check_topic_name(name) is None) == (
        _accepted(validation.validate_topic_name, name) and "{" not in name
    )


@given(names)
def test_namespace_check_agrees_with_rmw(name: str) -> None:
    """The rule for absolute namespaces is that of ROS 2."""
    validation = pytest.importorskip("rclpy.validate_namespace")
    absolute = f"/{name}"
    assert (check_namespace(absolute) is None) == _accepted(validation.validate_namespace, absolute)


def _accepted(validate: object, name: str) -> bool:
    """Return whether a validator of rclpy, which raises for an invalid name, accepts the name."""
    try:
        validate(name)  # type: ignore[operator]
    except (ValueError, TypeError):
        return False
    except Exception as error:  # the exceptions of rclpy have no common base but Exception
        assert type(error).__module__ == "rclpy.exceptions"  # noqa: PT017 (any other is a failure)
        return False
    return True


@pytest.mark.parametrize(
    ("name", "reason"),
    [
        ("", "is empty"),
        ("a-b", "contains '-'"),
        ("a/", "ends with '/'"),
        ("/", "ends with '/'"),
        ("a//b", "empty part"),
        ("a/1b", "starts with a digit"),
        ("~x", "without '/' behind it"),
        ("a/~", "'~' after its start"),
        ("/" + "a" * 300, "longer than"),
    ],
)
def test_invalid_topic_name_has_a_reason(name: str, reason: str) -> None:
    """The reason completes the sentence 'the name …'."""
    problem = check_topic_name(name)
    assert problem is not None
    assert reason in problem


@pytest.mark.parametrize("name", ["/scan", "scan", "~/reset", "a/b_1", "~", "_x"])
def test_valid_topic_names_are_accepted(name: str) -> None:
    """Absolute, relative and private names are accepted."""
    assert check_topic_name(name) is None


@pytest.mark.parametrize("name", ["std_msgs", "a1", "my_robot_2"])
def test_valid_package_names_are_accepted(name: str) -> None:
    """Names that conform to REP 144 are accepted."""
    assert check_package_name(name) is None


@pytest.mark.parametrize("name", ["", "a", "Upper", "a-b", "1ab", "a__b", "ab_", "_ab"])
def test_invalid_package_names_have_a_reason(name: str) -> None:
    """Names that REP 144 or rosidl rejects have a reason."""
    assert check_package_name(name)


@pytest.mark.parametrize("name", ["", "a b", "a..b", ".a", "a.", "a:b", "ü", "a" * 2000])
def test_invalid_parameter_names_have_a_reason(name: str) -> None:
    """Names that some ROS 2 tool cannot handle have a reason."""
    assert check_parameter_name(name)


@pytest.mark.parametrize(
    "name", ["pid.gains.p", "qos_overrides./tf.publisher.depth", "a-b", "3d", "/", "a.1", "x/"]
)
def test_valid_parameter_names_are_accepted(name: str) -> None:
    """Letters, digits and ``_ . / -`` are accepted, in parts separated by dots."""
    assert check_parameter_name(name) is None


@pytest.mark.parametrize(("name", "passes"), [("tick", True), ("2nd", False), ("a.b", False)])
def test_timer_name_must_be_valid_in_a_method_name(name: str, passes: bool) -> None:
    """The name of a timer becomes part of a method name."""
    assert (check_timer_name(name) is None) is passes


@pytest.mark.parametrize("name", ["/", "/a/b", "front", "a/b"])
def test_valid_namespaces_are_accepted(name: str) -> None:
    """A namespace may be the root, absolute or relative."""
    assert check_namespace(name) is None


def test_empty_namespace_is_invalid() -> None:
    """Empty namespaces and invalid node names have a reason."""
    assert check_namespace("") == "is empty"
    assert check_node_name("1a") == "starts with a digit"
    assert "longer" in (check_node_name("a" * 256) or "")


def test_near_any_finds_what_near_finds() -> None:
    """Those of each name, the name itself never."""
    wanted, candidates = ["speeed", "Front", "rear"], ["speed", "front", "rear", "reat", "mode"]
    each = [set(near(name, candidates)) for name in wanted]
    assert near_any(wanted, candidates) == set().union(*each) == {"speed", "front", "reat"}
    assert near_any([], candidates) == near_any(wanted, []) == set()
