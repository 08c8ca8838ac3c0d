"""Recordings as systems: what is written, and that it means what was recorded."""

from __future__ import annotations

import struct
from pathlib import Path

import lz4.frame  # type: ignore[import-untyped]
import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st
from rosbags.interfaces import QosDurability, QosLiveliness, QosReliability, QosTime
from rosbags.rosbag2 import CompressionMode, StoragePlugin

from deros.generators.output.writer import write
from deros.importers.kept import renewed
from deros.importers.readers import Request, UnreadableError
from deros.importers.recordings.reading import read_recordings
from deros.importers.results import Imported
from deros.interfaces.store import InterfaceStore
from tests.support.checks import checked
from tests.support.recorded import BEST_EFFORT, LATCHED, SEPARATOR, Topic, qos, record, storage_file
from tests.support.rules import embedded_store

MCAP, SQLITE = StoragePlugin.MCAP, StoragePlugin.SQLITE3
OWN = f"""# A wheel
other_msgs/Part left  # [rad]
std_msgs/Header header
{SEPARATOR}
MSG: other_msgs/Part
float64 angle 1.5
string<=5[<=3] names
"""
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


def read(*paths: Path, store: InterfaceStore | None = None) -> Imported:
    """Return the models of recordings; by default nothing is known but what ships with deros."""
    store = store or embedded_store()
    return read_recordings(Request(paths, None, Path(), store.exists, store))


def topics(imported: Imported) -> list[str]:
    """Return the lines of the system, without the keyword above them."""
    (parts,) = imported.files.values()
    first, *lines = parts.body.splitlines()
    assert first == "topics"
    return [line.strip() for line in lines]


def findings(imported: Imported, folder: Path) -> list[str]:
    """Write models, and return what a check says of them."""
    write(renewed(imported.files, folder).files, folder)
    for path, text in imported.interfaces.items():
        (folder / path).parent.mkdir(parents=True, exist_ok=True)
        (folder / path).write_text(text, encoding="utf-8")
    store = InterfaceStore([folder / "interfaces"], prefixes=())
    return [each.message for each in checked(folder / "robot.system", store=store)]


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
        "external topic /imu : sensor_msgs.Imu qos best_effort volatile  // 101 messages, 100 Hz",
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


def test_rare_messages_have_a_time_instead_of_a_rate(tmp_path: Path) -> None:
    """On average over the whole recording."""
    path = record(
        tmp_path / "bag",
        Topic("/fast", "std_msgs/msg/Bool", 4001, 1),
        Topic("/slow", "std_msgs/msg/Bool", 2, 4000),
    )
    assert [line.partition("// ")[2] for line in topics(read(path))] == [
        "4001 messages, 1000 Hz",
        "2 messages, one in 4 s",
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
        "external topic /a : std_msgs.Bool qos reliable volatile  // 11 messages, 10 Hz",
        "external topic /b : std_msgs.Bool  // 14 messages, 6 Hz, publishers with different QoS: "
        "reliable volatile; reliable transient_local",
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


# Damaged and hostile files ------------------------------------------------------------------------


@pytest.mark.parametrize("compression", [CompressionMode.NONE, CompressionMode.STORAGE])
def test_mcap_that_was_cut_off_is_read_up_to_there(
    compression: CompressionMode, tmp_path: Path
) -> None:
    """A recorder that was killed left no end, and no metadata.yaml."""
    path = record(
        tmp_path / "bag",
        Topic("/a", "std_msgs/msg/Bool", 5),
        Topic("/imu", "own_msgs/msg/Wheel", 5, definition=OWN),
        compression=compression,
    )
    whole = topics(read(path))
    (path / "metadata.yaml").unlink()
    file = storage_file(path)
    content = file.read_bytes()
    ends = {len(content) - 1, len(content) - 40, _data_end(content) + 1, _data_end(content)}
    for end in sorted(ends):
        file.write_bytes(content[:end])
        imported = read(path)
        assert topics(imported) == whole
        assert imported.missing == (
            f"{path}: metadata.yaml is of no use: there is no metadata.yaml in it",
            f"{file}: what was behind byte {_data_end(content)} is missing: the file was cut off",
        )
        assert read(file).missing == imported.missing[1:]
        assert len(imported.interfaces) == 2


def _data_end(content: bytes) -> int:
    """Return where the record begins that ends the data of an MCAP file."""
    at = 8
    while content[at] != 0x0F:
        at += 9 + int(struct.unpack_from("<Q", content, at + 1)[0])
    return at


def test_mcap_without_chunks_loses_only_the_last_message(tmp_path: Path) -> None:
    """What is whole before the cut counts."""
    path = record(tmp_path / "bag", Topic("/a", "std_msgs/msg/Bool", 5))
    file = tmp_path / "cut.mcap"
    content = storage_file(path).read_bytes()
    records = _chunk_content(content)
    magic, head = content[:8], content[8 : 8 + 9 + struct.unpack_from("<Q", content, 9)[0]]
    file.write_bytes(magic + head + records[:-1])
    assert topics(read(file))[0].endswith("// 4 messages, 10 Hz")


def _chunk_content(content: bytes) -> bytes:
    """Return the records in the only chunk of an MCAP file that is not compressed."""
    at = 8
    while content[at] != 0x06:
        at += 9 + int(struct.unpack_from("<Q", content, at + 1)[0])
    # Times (16), size (8), checksum (4), name of the compression (4, empty), size (8).
    (size,) = struct.unpack_from("<Q", content, at + 9 + 32)
    start = at + 9 + 40
    return content[start : start + size]


def test_chunks_in_lz4_are_read(tmp_path: Path) -> None:
    """Recorders can write them, rosbags cannot."""
    path = record(tmp_path / "bag", Topic("/a", "std_msgs/msg/Bool", 5))
    content = storage_file(path).read_bytes()
    records = _chunk_content(content)
    packed = lz4.frame.compress(records)
    name = b"lz4"
    chunk = struct.pack("<QQQII", 0, 0, len(records), 0, len(name)) + name
    chunk += struct.pack("<Q", len(packed)) + packed
    head = content[: 17 + struct.unpack_from("<Q", content, 9)[0]]
    file = tmp_path / "packed.mcap"
    file.write_bytes(head + b"\x06" + struct.pack("<Q", len(chunk)) + chunk)
    assert topics(read(file)) == topics(read(path))
    file.write_bytes(file.read_bytes().replace(b"lz4", b"xyz"))
    with pytest.raises(UnreadableError, match=r"packed\.mcap: is not a recording .*xyz"):
        read(file)


def test_folder_with_useless_metadata_is_read_by_its_files(tmp_path: Path) -> None:
    """As long as it has files that say enough."""
    path = record(tmp_path / "bag", Topic("/a", "std_msgs/msg/Bool"), storage=SQLITE)
    whole = topics(read(path))
    (path / "metadata.yaml").write_text("rosbag2_bagfile_information: {version: 99}")
    imported = read(path)
    assert topics(imported) == whole
    (missing,) = imported.missing
    assert missing.startswith(f"{path}: metadata.yaml is of no use: is not a recording that can be")
    storage_file(path).unlink()
    with pytest.raises(UnreadableError, match="version 99"):
        read(path)


@pytest.mark.parametrize("storage", [MCAP, SQLITE])
def test_names_of_files_may_have_any_character(storage: StoragePlugin, tmp_path: Path) -> None:
    """Those that mean something in a URI, too."""
    path = record(tmp_path / "bag", Topic("/a", "std_msgs/msg/Bool"), storage=storage)
    whole = topics(read(path))
    file = storage_file(path)
    odd = file.rename(tmp_path / f"a?b#c%20 d\u00e4{file.suffix}")
    assert read(odd).missing == ()
    assert topics(read(odd)) == whole


def test_what_is_not_a_recording_is_unreadable(tmp_path: Path) -> None:
    """The reason names the path."""
    empty = tmp_path / "empty.mcap"
    empty.write_bytes(b"")
    text = tmp_path / "text.mcap"
    text.write_text("hello")
    pipe = tmp_path / "no.db3"
    pipe.mkdir()
    database = tmp_path / "text.db3"
    database.write_text("hello" * 200)
    huge = tmp_path / "huge"
    huge.mkdir()
    (huge / "metadata.yaml").write_bytes(b" " * (17 << 20))
    deep = tmp_path / "deep"
    deep.mkdir()
    (deep / "metadata.yaml").write_bytes(b"[" * 100_000)
    packed = tmp_path / "bag.mcap.zstd"
    packed.write_bytes(b"")
    other = tmp_path / "bag.txt"
    other.write_text("hello")
    silent = record(tmp_path / "silent", Topic("/rosout", "rcl_interfaces/msg/Log"))
    for path, why in {
        empty: "",
        text: "magic",
        pipe: "there is no metadata.yaml in it",
        database: "not a database",
        huge: "longer than",
        deep: "",
        packed: "is compressed as a whole: name its folder",
        silent: "no topic but those of ROS 2 itself is recorded",
        tmp_path / "none.mcap": "there is no such file",
        other: "is neither .mcap nor .db3 by its name",
    }.items():
        with pytest.raises(UnreadableError) as raised:
            read(path)
        assert str(raised.value).startswith(str(path)), why
        assert why in str(raised.value)
        assert str(raised.value).isprintable()


def test_truncated_database_is_unreadable(tmp_path: Path) -> None:
    """No reader of SQLite takes one."""
    file = storage_file(
        record(tmp_path / "bag", Topic("/a", "std_msgs/msg/Bool", 2000), storage=SQLITE)
    )
    file.write_bytes(file.read_bytes()[:-5000])
    with pytest.raises(UnreadableError, match=str(file)):
        read(file)


@pytest.fixture(scope="module")
def healthy(tmp_path_factory: pytest.TempPathFactory) -> dict[str, bytes]:
    """Return the files of recordings by their suffixes."""
    folder = tmp_path_factory.mktemp("healthy")
    contents: dict[str, bytes] = {}
    for storage in (MCAP, SQLITE):
        path = record(
            folder / storage.name,
            Topic("/a", "std_msgs/msg/Bool", 2),
            Topic("/w", "own_msgs/msg/Wheel", 2, definition=OWN),
            Topic("/fib/_action/status", "action_msgs/msg/GoalStatusArray"),
            storage=storage,
        )
        file = storage_file(path)
        contents[file.suffix] = file.read_bytes()
        contents[f"{file.suffix}.yaml"] = (path / "metadata.yaml").read_bytes()
    return contents


@st.composite
def damages(draw: st.DrawFn) -> list[tuple[float, bytes, int]]:
    """Draw places of a file (as shares of it), what is written there, and how much it replaces."""
    byte = st.sampled_from([b"\0", b"\xff", b"\x7f", b"/", b"\n", b"-", b"1", b"\x06", b""])
    text = byte | st.binary(max_size=9)
    place = st.floats(0, 1, exclude_max=True)
    return draw(st.lists(st.tuples(place, text, st.integers(0, 9)), min_size=1, max_size=6))


@settings(
    max_examples=150, deadline=None, suppress_health_check=[HealthCheck.function_scoped_fixture]
)
@given(
    suffix=st.sampled_from([".mcap", ".db3", ".mcap.yaml", ".db3.yaml"]),
    damage=damages(),
    end=st.none() | st.floats(0, 1),
)
def test_damaged_files_end_in_a_sentence_or_in_models_that_check_clean(
    suffix: str,
    damage: list[tuple[float, bytes, int]],
    end: float | None,
    healthy: dict[str, bytes],
    tmp_path_factory: pytest.TempPathFactory,
) -> None:
    """Never in a traceback, nor in a model that a hostile file wrote into."""
    content = bytearray(healthy[suffix])
    for place, text, replaced in damage:
        at = int(place * len(content))
        content[at : at + replaced] = text
    if end is not None:
        del content[int(end * len(content)) :]
    folder = tmp_path_factory.mktemp("damaged")
    storage = suffix.removesuffix(".yaml")
    target = folder / f"{storage[1:].upper().replace('DB3', 'SQLITE3')}{storage}"
    target.write_bytes(content if suffix == storage else healthy[storage])
    path = target
    if suffix != storage:
        (folder / "metadata.yaml").write_bytes(content)
        path = folder
    try:
        imported = read(path)
    except UnreadableError as error:
        said = str(error)
    else:
        said = f"{path}: is read"
        assert all(each.isprintable() for each in imported.missing)
        assert findings(imported, folder / "out") == []
    assert said.startswith(str(path))
    assert said.isprintable()
