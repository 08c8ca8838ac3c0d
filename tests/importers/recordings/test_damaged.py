"""Recordings that were cut off, damaged or made to harm, and paths that are none."""

from __future__ import annotations

import struct
from pathlib import Path

import lz4.frame  # type: ignore[import-untyped]
import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st
from rosbags.rosbag2 import CompressionMode, StoragePlugin

from deros.importers.readers import UnreadableError
from deros.importers.recordings.recognized import is_recording
from tests.support.recorded import (
    MCAP,
    OWN,
    SQLITE,
    Topic,
    findings,
    read,
    record,
    storage_file,
    topics,
)


def test_recordings_are_recognized_by_their_names(tmp_path: Path) -> None:
    """A folder by what is in it."""
    path = record(tmp_path / "bag", Topic("/a", "std_msgs/msg/Bool"))
    (tmp_path / "x.mcap.yaml").write_text("")
    assert not is_recording(tmp_path)
    assert not is_recording(tmp_path / "x.mcap.yaml")
    assert is_recording(path)
    (path / "metadata.yaml").unlink()
    assert is_recording(path)
    assert is_recording(storage_file(path))
    assert is_recording(Path("there/is/no.db3"))
    storage_file(path).unlink()
    assert not is_recording(path)


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
