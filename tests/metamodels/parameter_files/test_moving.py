"""Files whose keys are moved say the same below a namespace, to ROS 2 and to the checks."""

from __future__ import annotations

import re
from dataclasses import replace
from pathlib import Path

import pytest
from hypothesis import HealthCheck, example, given, settings
from hypothesis import strategies as st

from deros.diagnostics import SourceFile, Span
from deros.generators.system.script.standalone.made import under
from deros.generators.system.script.standalone.made.below import moved
from deros.generators.system.script.standalone.made.under import put_under
from deros.metamodels.parameter_files.library import ParameterFiles
from deros.models.parameter_files import (
    Below,
    Document,
    Fault,
    ParameterFile,
    Plain,
    Unmovable,
)
from tests.metamodels.parameter_files.test_reading import FILES
from tests.support import rcl_yaml

pytest.importorskip("rclpy")

NAMESPACES = ("r1", "/r1", "a/b_2", "/")
TEXTS = st.one_of(
    st.sampled_from(["7", "on", "~", "1e3", '"x"', "é", "a b", "|", ">", "|-", "|2", "!!str 7"]),
    st.lists(st.sampled_from(["a", "#", "-", ":", " ", "  ", "\n", "\n  ", "\t", "'", "x y"])).map(
        "".join
    ),
)
_LINES = st.lists(
    st.one_of(
        st.sampled_from(
            [
                *("a:\n", "ns:\n", "  b:\n", " ros__parameters:\n", "  ros__parameters:\n"),
                *("    x: |\n", "      two\n\n", "       three\n", "    y: >-\n", "    l: [1,\n"),
                *("n/b:\n", "  b/c:\n", "{n/b: {ros__parameters: {x: 1}},\n", "a.b: {c: 1}\n"),
                *("  2]\n", "2]\n", "    z: 'a\n", "  b'\n", "---\n", "--- # c\n", "...\n"),
                *("# c\n", "  # c\n", "\n", "   \n", "%YAML 1.1\n", "--- {a: 1}\n", "--- a\n"),
                *("    v: |2\n", "\t\n", "    w: 1\r\n", "{a: {ros__parameters: {x: 1,\n", "}}}\n"),
                *("    u: a\x85", "    t: \u2028", "? a\n", ": ", "!!map\n", "--- !!map\n"),
            ]
        ),
        TEXTS.map(lambda text: f"    p: {text}\n"),
    ),
    max_size=12,
).map("".join)
# Inside of a file, ROS 2 takes a byte order mark only where a line begins with it.
LAYOUTS = st.builds(str.__add__, st.sampled_from(["", "", "\ufeff"]), _LINES)


def _below(read: rcl_yaml.Read | None, namespace: str) -> rcl_yaml.Read | None:
    """Return what ROS 2 reads of a file, below a namespace."""
    start = namespace.rstrip("/") + "/"
    return None if read is None else [(start + key, values) for key, values in read]


def _as(read: rcl_yaml.Read | None, parameter: str) -> rcl_yaml.Read | None:
    """Return what ROS 2 reads of a file for all, with its parameters below another one."""
    start = f"{parameter}." if parameter else ""
    return read and [(key, [(start + n, value) for n, value in values]) for key, values in read]


def _checked(folder: Path, way: Below | Plain) -> rcl_yaml.Read | None:
    """Return what the checks read of a file; nothing of one that they refuse."""
    found = _statement(folder, way).load()
    if not isinstance(found, Document):
        return None
    return [(each.key, [(v.name, v.value) for v in each.values]) for each in found.sections]


def _statement(folder: Path, way: Below | Plain) -> ParameterFile:
    span = way.span
    found = ParameterFile(str(folder / "x.yaml"), span, span, ParameterFiles().load)
    if isinstance(way, Plain):
        return replace(found, plain=way)
    return replace(found, below=way)


SPAN = Span(SourceFile("x.system", "x"), 0, 0)


def _made(folder: Path, text: str, keys: tuple[str, ...]) -> rcl_yaml.Read | None:
    """Return what ROS 2 reads of a text under keys, whether that may be put there or not."""
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(under, "_check_keys", lambda *_: None)
        (folder / "made.yaml").write_bytes(put_under(text, keys).encode())
    return rcl_yaml.read(folder / "made.yaml")


def _is_put_under(text: str, keys: tuple[str, ...]) -> bool:
    try:
        put_under(text, keys)
    except ValueError:
        return False
    return True


def _same(folder: Path, text: str, namespace: str) -> None:
    (folder / "x.yaml").write_bytes(text.encode())
    before, after = rcl_yaml.read(folder / "x.yaml"), _made(folder, text, (namespace,))
    checked = _checked(folder, Below(namespace, SPAN))
    if before is None:
        assert checked is None, (text, namespace)
        # Without a node's name above it, this is nobody's: below a namespace, a node's.
        is_named_by_namespace = re.search(r"^\W*ros__parameters", text, re.MULTILINE) is not None
        assert after is None or is_named_by_namespace, (text, namespace)
        return
    # A key of several names may have ROS 2 take others for parts of it.
    is_strayed = after is not None and repr(after) != repr(_below(before, namespace))
    assert repr(checked) == repr(None if is_strayed else after), (text, namespace)
    if is_strayed:
        with pytest.raises(ValueError, match="for parts of it"):
            moved(text, namespace)
    # A file that says nothing, such as a word alone, may be refused where a key needs more.
    is_movable = before != [] and not any(line.startswith("/") for line in text.splitlines())
    if after is None:
        assert not is_movable, (text, namespace)


@settings(max_examples=300, deadline=None, suppress_health_check=list(HealthCheck))
@given(text=FILES, namespace=st.sampled_from(NAMESPACES))
@example("ns/a: {ros__parameters: {}}\na: {ros__parameters: {}}\n", "r1")
@example("ns: {x/y: {ros__parameters: {}}, z: {ros__parameters: {}}}\n", "r1")
def test_values_and_keys_stay_what_they_are(
    tmp_path_factory: pytest.TempPathFactory, text: str, namespace: str
) -> None:
    """Types, order, and what is refused; a key with a leading ``/`` is refused below another."""
    _same(tmp_path_factory.mktemp("moved"), text, namespace)


@settings(max_examples=300, deadline=None, suppress_health_check=list(HealthCheck))
@given(text=LAYOUTS, namespace=st.sampled_from(NAMESPACES))
@example("--- {a: {ros__parameters: {x: 1}}}\n---\nb: {ros__parameters: {x: 2}}", "r1")
@example("a: {ros__parameters: {x: |\n  y}}", "r1")
@example("a:\n ros__parameters:\n  x: |\n\n    two\n\n   # c\n\n  y: 2", "r1")
@example("--- a: 1\n", "r1")
def test_layouts_stay_what_they_are(
    tmp_path_factory: pytest.TempPathFactory, text: str, namespace: str
) -> None:
    """Blocks, comments, documents, directives and line ends; what is broken stays so."""
    _same(tmp_path_factory.mktemp("layouts"), text, namespace)


@pytest.mark.parametrize(
    ("text", "key"),
    [
        ("a: {ros__parameters: {x: 1}}\n/**: {ros__parameters: {x: 1}}", "/**"),
        ("/x: {a: {ros__parameters: {x: 1}}}", "/x"),
    ],
)
def test_key_that_cannot_move_is_named(tmp_path: Path, text: str, key: str) -> None:
    """At its place in the file, with the key that ROS 2 refuses."""
    (tmp_path / "x.yaml").write_text(text)
    span = Span(SourceFile(str(tmp_path / "x.system"), "x"), 0, 0)
    load = ParameterFiles().load
    found = ParameterFile("x.yaml", span, span, load, below=Below("r1", span)).load()
    assert isinstance(found, Unmovable)
    assert (found.span.text, found.span.start) == (key, text.index(key))
    assert f"'r1/{key}'" in found.message


@pytest.mark.parametrize(
    ("text", "key", "strayed", "read", "nested"),
    [
        (
            "ns/a: {ros__parameters: {x: 1}}\na: {ros__parameters: {x: 2}}",
            "ns/a",
            "a",
            "r1/ns/a",
            "ns: {a: …}",
        ),
        (
            "ns:\n  x/y: {ros__parameters: {x: 1}}\n  z: {}\nb:\n  ros__parameters: {x: 2}",
            "x/y",
            "b",
            "r1/ns/b",
            "x: {y: …}",
        ),
        (
            '"**/a": {b: {}}\nc/d: {}\nc: {d: {ros__parameters: {x: 2}}}',
            '"**/a"',
            "c/d",
            "r1/**/c/c/d",
            '"**": {a: …}',
        ),
    ],
)
def test_key_is_named_behind_which_another_would_stray(
    tmp_path: Path, text: str, key: str, strayed: str, read: str, nested: str
) -> None:
    """With what ROS 2 would read, and what to write; the script says it, too."""
    (tmp_path / "x.yaml").write_text(text)
    found = _statement(tmp_path, Below("r1", SPAN)).load()
    assert isinstance(found, Unmovable)
    assert (found.span.text, found.span.start) == (key, text.index(key))
    name = key.strip('"')
    assert found.message == (
        f"behind '{name}', '{strayed}' cannot be moved below 'r1': ROS 2 would read '{read}'"
    )
    assert found.hint == f"nest the names in it: '{nested}'"
    expected = f"keys behind '{name}' for parts of it: write {nested.replace('…', '...')}"
    with pytest.raises(ValueError, match=re.escape(expected)):
        moved(text, "r1")


def test_parameter_is_named_behind_which_another_would_stray(tmp_path: Path) -> None:
    """Below another one; where the names of a plain file begin, none of them can."""
    text = "a.b: 1\nb.c:\n  e: 1\nd: 2\n"
    (tmp_path / "x.yaml").write_text(text)
    found = _statement(tmp_path, Plain("arm", SPAN)).load()
    assert isinstance(found, Unmovable)
    assert (found.span.text, found.hint) == ("b.c", "nest the names in it: 'b: {c: …}'")
    assert "'d' cannot be moved below 'arm': ROS 2 would read 'arm.b.d'" in found.message
    with pytest.raises(ValueError, match=r"behind 'b\.c' for parts of it: write b: \{c"):
        put_under(text, Plain("arm", SPAN).keys)
    assert put_under(text, Plain("", SPAN).keys)
    assert isinstance(_statement(tmp_path, Plain("", SPAN)).load(), Document)


@pytest.mark.parametrize(
    ("text", "keys"),
    [
        ("? ns/a\n: {ros__parameters: {x: 1}}\n? a\n: {ros__parameters: {x: 2}}", ("r1",)),
        ('{"ns/a": {ros__parameters: {x: 1}},\n"a": {ros__parameters: {x: 2}}}', ("r1",)),
        ('"ns\\x2fa": {ros__parameters: {x: 1}}\na: {ros__parameters: {x: 2}}', ("r1",)),
        ("a: {ros__parameters: {x: 1,\n  y: 2}, b/c: {}}\nd: {ros__parameters: {x: 2}}", ("r1",)),
        ("--- !!map\nb.c: !!map\n  e: 1\nd: 2\n", Plain("arm", SPAN).keys),
        ("a: {}\nb.c: 7\n", Plain("arm", SPAN).keys),
    ],
)
def test_script_refuses_what_would_stray_however_it_is_laid_out(
    tmp_path: Path, text: str, keys: tuple[str, ...]
) -> None:
    """As ROS 2 reads it otherwise, or the check refuses it."""
    assert _made(tmp_path, text, keys) is not None
    with pytest.raises(ValueError, match="for parts of it"):
        put_under(text, keys)


VALUES = st.recursive(
    st.sampled_from(["7", "on", "~", "1e3", '"x"', "é", "[1, 2]", "[a, 'b']", "[1, 2.0]", "[]"]),
    lambda inner: st.dictionaries(
        st.sampled_from(["a", "b.c", "d/e", "'f g'", "7"]), inner, max_size=3
    ),
    max_leaves=8,
)


def _yaml(value: object, depth: int = 0) -> str:
    if not isinstance(value, dict):
        return f" {value}\n"
    inside = "".join(f"{'  ' * depth}{name}:{_yaml(v, depth + 1)}" for name, v in value.items())
    return f"\n{inside}" if inside else " {}\n"


@settings(max_examples=300, deadline=None, suppress_health_check=list(HealthCheck))
@given(value=VALUES, parameter=st.sampled_from(["", "arm", "robot.kinematics.arm"]))
@example({"a": {"a": "7"}, "b.c": "on"}, "arm")
def test_plain_file_says_what_ros_reads_of_what_is_made_of_it(
    tmp_path_factory: pytest.TempPathFactory, value: object, parameter: str
) -> None:
    """Names, types, order, and what is refused."""
    folder = tmp_path_factory.mktemp("plain")
    text = _yaml(value)
    plain = Plain(parameter, SPAN)
    (folder / "x.yaml").write_bytes(text.encode())
    read, alone = (_made(folder, text, keys) for keys in (plain.keys, plain.keys[:2]))
    checked = _checked(folder, plain)
    is_same = not isinstance(value, dict) or repr(read) == repr(_as(alone, parameter))
    if read is None or is_same:
        assert repr(checked) == repr(read), text
    elif all(value is not None for _, values in read for _, value in values):
        assert checked is None, text
        assert not _is_put_under(text, plain.keys), text
    # What has no value is reported by itself, and ends the node.


FAR = f"\n{' ' * 40}"
FULL = st.recursive(
    st.sampled_from(
        [
            *("7", '"b.c: d"', "[1, 2]", "b.c  # e.f: g", "/b/c", "{a: {b: 1}}"),
            *(f"{FAR}- a", f"|{FAR}x.y: z", f"\n# b.c:{FAR}- 7"),
        ]
    ),
    lambda inner: st.dictionaries(
        st.sampled_from(["a", "b.c", "'d.e'", "f/g"]), inner, min_size=1, max_size=3
    ),
    max_leaves=8,
).filter(lambda value: isinstance(value, dict))
NODE = FULL.map(lambda value: {"ros__parameters": {"/tf": {"x": "1"}, "v": value}})
NAMED = st.recursive(
    NODE,
    lambda inner: st.dictionaries(
        st.sampled_from(["a", "b/c", "'d/e'", "f"]), inner, min_size=1, max_size=3
    ),
    max_leaves=6,
).filter(lambda value: "ros__parameters" not in value)


@settings(max_examples=300, deadline=None, suppress_health_check=list(HealthCheck))
@given(named=NAMED, plain=FULL)
@example({"a": {"b/c": {"ros__parameters": {"x": "1"}}}, "f": {"ros__parameters": {"x": "1"}}}, {})
def test_system_starts_with_files_that_the_checks_accept(
    tmp_path_factory: pytest.TempPathFactory, named: object, plain: object
) -> None:
    """Where they are laid out in lines, and with no others."""
    folder = tmp_path_factory.getbasetemp()
    for value, way, keys in (
        (named, Below("r1", SPAN), ("r1",)),
        (plain, Plain("arm", SPAN), Plain("arm", SPAN).keys),
    ):
        text = _yaml(value)
        (folder / "x.yaml").write_text(text)
        assert _is_put_under(text, keys) == (_checked(folder, way) is not None), text


@settings(max_examples=300, deadline=None, suppress_health_check=list(HealthCheck))
@given(text=LAYOUTS.map(lambda text: text.replace("ros__parameters", "c")))
@example("? [x]\n: {}\na: {}\n")
def test_layouts_of_plain_files_are_read_alike(
    tmp_path_factory: pytest.TempPathFactory, text: str
) -> None:
    """Blocks, comments, documents, directives and line ends."""
    folder = tmp_path_factory.mktemp("plain")
    plain = Plain("arm", SPAN)
    (folder / "x.yaml").write_bytes(text.encode())
    checked, is_put_under = _checked(folder, plain), _is_put_under(text, plain.keys)
    if checked is not None:
        assert repr(_made(folder, text, plain.keys)) == repr(checked), text
        assert is_put_under, text


def test_file_with_names_of_nodes_is_not_plain(tmp_path: Path) -> None:
    """It says for which nodes it is, and would set parameters of strange names."""
    (tmp_path / "x.yaml").write_text("eye:\n  ros__parameters:\n    rate: 1.0\n")
    found = _statement(tmp_path, Plain("", SPAN)).load()
    assert isinstance(found, Fault)
    assert found.span.text == "ros__parameters"
    assert "leave 'plain' out" in found.hint


@pytest.mark.parametrize("namespace", ["", "a b", "r1/", "//a", "1r", "~", "a/**", "a:\nb"])
def test_what_is_not_a_namespace_is_refused(namespace: str) -> None:
    """Where the system is started; the empty one is not asked for."""
    with pytest.raises(ValueError, match="is not a namespace"):
        moved("", namespace)
