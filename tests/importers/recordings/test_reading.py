"""Recordings as systems: what is written, and that it means what was recorded."""

from __future__ import annotations

from pathlib import Path

import pytest
from rosbags.interfaces import QosDurability, QosLiveliness, QosReliability, QosTime
from rosbags.rosbag2 import CompressionMode, StoragePlugin

from tests.support.recorded import (
    BEST_EFFORT,
    LATCHED,
    MCAP,
    OWN,
    SEPARATOR,
    SQLITE,
    Topic,
    findings,
    qos,
    read,
    record,
    storage_file,
    topics,
)

IDL = f"""{SEPARATOR}
IDL: own_msgs/msg/Thing
#include "std_msgs/msg/Header.idl"
module own_msgs {{
  module msg {{
    module Thing_Constants {{ const string WORD = "it's"; }};
    typedef double double__9[9];
    struct Thing {{ std_msgs::msg::Header header; sequence<octet, 5> bytes; double__9 matrix; }};
  }};
}};
"""


@pytest.mark.parametrize("version", [8, 9])
@pytest.mark.parametrize(
    ("storage", "compression"),
    [
        (MCAP, CompressionMode.NONE),
        (MCAP, CompressionMode.STORAGE),
        (MCAP, CompressionMode.MESSAGE),
        (MCAP, CompressionMode.FILE),
        (SQLITE, CompressionMode.NONE),
        (SQLITE, CompressionMode.MESSAGE),
        (SQLITE, CompressionMode.FILE),
    ],
)
def test_each_storage_and_compression_gives_the_same_system(
    storage: StoragePlugin, compression: CompressionMode, version: int, tmp_path: Path
) -> None:
    """Topics, types, QoS and numbers of messages do not depend on how they are stored."""
    path = record(
        tmp_path / "bag",
        Topic("/imu", "sensor_msgs/msg/Imu", 101, 10, [BEST_EFFORT]),
        Topic("/wheel", "own_msgs/msg/Wheel", 3, 400, [LATCHED], OWN),
        Topic("/silent", "std_msgs/msg/Bool", 0),
        storage=storage,
        compression=compression,
        version=version,
    )
    imported = read(path)
    assert imported.missing == ()
    assert topics(imported) == [
        "external topic /imu : sensor_msgs.Imu qos best_effort volatile rate 100 Hz  "
        "// 101 messages",
        "external topic /silent : std_msgs.Bool qos reliable volatile  // 0 messages",
        "external topic /wheel : own_msgs.Wheel qos reliable transient_local  // 3 messages, 2 Hz",
    ]
    first, _, second = OWN.partition(f"{SEPARATOR}\nMSG: other_msgs/Part\n")
    assert imported.interfaces == {
        "interfaces/other_msgs/msg/Part.msg": second,
        "interfaces/own_msgs/msg/Wheel.msg": first,
    }
    assert findings(imported, tmp_path / "out") == []
    if compression is not CompressionMode.FILE:
        assert read(storage_file(path)) == imported


def test_qos_that_a_topic_cannot_say_is_a_comment(tmp_path: Path) -> None:
    """Several profiles; policies that are unknown, usual or infinite are not stated."""
    second, infinite = QosTime(1, 0), QosTime(2147483647, 4294967295)
    by_topic = QosLiveliness.MANUAL_BY_TOPIC
    strange = qos(QosReliability.UNKNOWN, QosDurability.SYSTEM_DEFAULT, infinite)
    imported = read(
        record(
            tmp_path / "bag",
            Topic("/a", "std_msgs/msg/Bool", offered=[qos(), BEST_EFFORT, qos()]),
            Topic("/b", "std_msgs/msg/Bool", offered=[strange]),
            Topic("/c", "std_msgs/msg/Bool", offered=[qos(deadline=QosTime(0, 300_000_000))]),
            Topic("/d", "std_msgs/msg/Bool", offered=[qos(liveliness=by_topic, lease=second)]),
            Topic("/e", "std_msgs/msg/Bool", offered=[]),
        )
    )
    assert topics(imported) == [
        "external topic /a : std_msgs.Bool  // 1 message, publishers with different QoS: "
        "reliable volatile; best_effort volatile",
        "external topic /b : std_msgs.Bool  // 1 message",
        "external topic /c : std_msgs.Bool qos reliable volatile deadline 300 ms  // 1 message",
        "external topic /d : std_msgs.Bool qos reliable volatile liveliness manual_by_topic "
        "lease 1 sec  // 1 message",
        "external topic /e : std_msgs.Bool  // 1 message",
    ]
    assert findings(imported, tmp_path / "out") == []


def test_few_messages_have_no_rate(tmp_path: Path) -> None:
    """How often they came stands in the comment; a rate is an average over the whole recording."""
    path = record(
        tmp_path / "bag",
        Topic("/fast", "std_msgs/msg/Bool", 4001, 1),
        Topic("/few", "std_msgs/msg/Bool", 10, 400),
        Topic("/slow", "std_msgs/msg/Bool", 2, 4000),
        Topic("/steady", "std_msgs/msg/Bool", 11, 400),
    )
    assert [line.partition(" : std_msgs.Bool ")[2] for line in topics(read(path))] == [
        "qos reliable volatile rate 1000 Hz  // 4001 messages",
        "qos reliable volatile  // 10 messages, 2.25 Hz",
        "qos reliable volatile  // 2 messages, one in 4 s",
        "qos reliable volatile rate 2.5 Hz  // 11 messages",
    ]


def test_topics_of_ros_itself_are_left_out_and_actions_and_services_are_named(
    tmp_path: Path,
) -> None:
    """An action is what its hidden topics belong to, as is a service whose calls are recorded."""
    event = "int32 x\n"
    path = record(
        tmp_path / "bag",
        Topic("/rosout", "rcl_interfaces/msg/Log"),
        Topic("/parameter_events", "rcl_interfaces/msg/ParameterEvent"),
        Topic("/lidar/transition_event", "lifecycle_msgs/msg/TransitionEvent"),
        Topic("/events/write_split", "rosbag2_interfaces/msg/WriteSplitEvent", definition=event),
        Topic("/fib/_action/status", "action_msgs/msg/GoalStatusArray"),
        Topic(
            "/fib/_action/feedback", "own_msgs/action/Fib_FeedbackMessage", definition="int32 x\n"
        ),
        Topic("/go/_action/status", "action_msgs/msg/GoalStatusArray"),
        Topic("/ask/_service_event", "own_msgs/srv/Ask_Event", definition=event),
        Topic("/other/rosout", "std_msgs/msg/Bool"),
    )
    imported = read(path)
    assert topics(imported) == [
        "external topic /ask  // a service: own_msgs.Ask",
        "external topic /fib  // an action: own_msgs.Fib",
        "external topic /go  // an action",
        "external topic /other/rosout : std_msgs.Bool qos reliable volatile  // 1 message",
    ]
    assert (imported.missing, imported.interfaces) == ((), {})
    assert findings(imported, tmp_path / "out") == []


def test_idl_is_converted(tmp_path: Path) -> None:
    """Constants, bounds and arrays stay."""
    imported = read(record(tmp_path / "bag", Topic("/t", "own_msgs/msg/Thing", definition=IDL)))
    assert imported.interfaces == {
        "interfaces/own_msgs/msg/Thing.msg": 'string WORD="it\'s"\nstd_msgs/Header header\n'
        "byte[<=5] bytes\nfloat64[9] matrix\n"
    }
    assert findings(imported, tmp_path / "out") == []


@pytest.mark.parametrize(
    ("definition", "why"),
    [
        ("other_msgs/Part left\n", "there is no definition of other_msgs.Part here or in the"),
        ("float128 x\n", "there is no definition of own_msgs.float128 here or in the recording"),
        ("float64 1x\n", "cannot be used, line 1: '1x' is not a field name"),
        (IDL.replace("struct", "union"), "is IDL that cannot be converted (the one that begins"),
        (IDL.replace("Thing", "Other"), "is not in its IDL"),
        ("own_msgs/Thing x\n", "it holds itself"),
        ("float64 x\n" * (1 << 17), "is longer than 1048576 characters"),
    ],
)
def test_topic_without_a_usable_type_is_left_out(definition: str, why: str, tmp_path: Path) -> None:
    """It is listed with the reason, and stands in a comment; nothing is written for it."""
    path = record(
        tmp_path / "bag",
        Topic("/t", "own_msgs/msg/Thing", definition=definition),
        Topic("/u", "std_msgs/msg/Bool"),
    )
    imported = read(path)
    (missing,) = imported.missing
    assert missing.startswith(f"{path}: topic /t : own_msgs.Thing is left out: ")
    assert why in missing
    assert missing.endswith("see --interfaces")
    bool_topic, comment = topics(imported)
    assert bool_topic.startswith("external topic /u")
    assert comment == "// " + missing.removeprefix(f"{path}: ")
    assert imported.interfaces == {}
    assert findings(imported, tmp_path / "out") == []


def test_names_and_types_that_models_cannot_have_are_left_out(tmp_path: Path) -> None:
    """Control characters in them do not reach the terminal or the model."""
    names = [
        ("relative", "own_msgs/msg/Thing"),
        ("/with blank", "own_msgs/msg/Thing"),
        ("/x", "../../etc/msg/Passwd"),
        ("/y", "own_msgs/srv/Thing"),
        ("/z\n\x1b[31m", "own_msgs/msg/Thing"),
    ]
    made = (Topic(name, kind, definition="float64 x\n") for name, kind in names)
    imported = read(record(tmp_path / "bag", *made, Topic("/u", "std_msgs/msg/Bool")))
    assert len(imported.missing) == len(names)
    assert all(each.isprintable() for each in imported.missing)
    assert imported.interfaces == {}
    assert findings(imported, tmp_path / "out") == []


def test_package_with_one_new_message_has_all_of_them(tmp_path: Path) -> None:
    """A folder hides the package of its name here, so what is known must be in it, too."""
    path = record(
        tmp_path / "bag",
        Topic("/new", "nav_msgs/msg/New", definition="float64 x\n"),
        Topic("/odom", "nav_msgs/msg/Odometry"),
        Topic("/imu", "sensor_msgs/msg/Imu"),
    )
    imported = read(path)
    assert set(imported.interfaces) == {
        "interfaces/nav_msgs/msg/New.msg",
        "interfaces/nav_msgs/msg/Odometry.msg",
    }
    assert imported.missing == ()
    assert findings(imported, tmp_path / "out") == []


def test_message_with_other_fields_than_here_is_listed(tmp_path: Path) -> None:
    """Checks and generators would read fields that the recorded robot does not have."""
    path = record(
        tmp_path / "bag",
        Topic("/a", "std_msgs/msg/Bool", definition="bool other\n"),
        Topic("/b", "std_msgs/msg/Char", definition="char data\n"),
    )
    assert read(path).missing == (
        "message std_msgs.Bool has other fields in the recordings than here, where checks look",
    )


# Several ----------------------------------------------------------------------------------------


def test_recordings_are_merged(tmp_path: Path) -> None:
    """Numbers are added; a rate counts the recordings that have the topic."""
    first = record(
        tmp_path / "first",
        Topic("/a", "std_msgs/msg/Bool", 11),
        Topic("/b", "std_msgs/msg/Bool", 11),
    )
    second = record(
        tmp_path / "second",
        Topic("/b", "std_msgs/msg/Bool", 3, 500, [LATCHED]),
        Topic("/c", "own_msgs/msg/Wheel", definition=OWN),
        storage=SQLITE,
    )
    imported = read(first, second)
    assert topics(imported) == [
        "external topic /a : std_msgs.Bool qos reliable volatile rate 10 Hz  // 11 messages",
        "external topic /b : std_msgs.Bool rate 6 Hz  // 14 messages, "
        "publishers with different QoS: reliable volatile; reliable transient_local",
        "external topic /c : own_msgs.Wheel qos reliable volatile  // 1 message",
    ]
    assert imported.missing == ()
    assert len(imported.interfaces) == 2


def test_conflicts_between_recordings_are_listed(tmp_path: Path) -> None:
    """A topic with two types has none; of two definitions the first one counts."""
    first = record(
        tmp_path / "first",
        Topic("/a", "std_msgs/msg/Bool"),
        Topic("/w", "own_msgs/msg/Wheel", definition="float64 x\n"),
    )
    second = record(
        tmp_path / "second",
        Topic("/a", "std_msgs/msg/Int32"),
        Topic("/w", "own_msgs/msg/Wheel", definition="float64 y\n"),
    )
    imported = read(first, second)
    assert imported.missing == (
        f"{second}: the definition of own_msgs.Wheel is not that of {first}, which is taken",
        f"the type of topic /a is left out: it is std_msgs.Bool in {first}, "
        f"std_msgs.Int32 in {second}",
    )
    assert topics(imported)[0] == "external topic /a qos reliable volatile  // 2 messages"
    assert imported.interfaces == {"interfaces/own_msgs/msg/Wheel.msg": "float64 x\n"}
    assert findings(imported, tmp_path / "out") == []
