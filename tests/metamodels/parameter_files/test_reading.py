"""Parameter files are read as ROS 2's own library reads them."""

from __future__ import annotations

from pathlib import Path

import pytest
from hypothesis import HealthCheck, example, given, settings
from hypothesis import strategies as st

from deros.diagnostics import SourceFile
from deros.metamodels.parameter_files.events import NotReadable, events
from deros.metamodels.parameter_files.reading import Overrides
from tests.support import rcl_yaml

pytest.importorskip("rclpy")

_SCALARS = (
    "true True TRUE yes Y on off N no False tRUE null ~ 7 +7 -7 007 08 0x1F -0xff 0x 1_000 1e3"
    " 1.5 1. .5 -.5 . 1e999 1e-400 4e-310 0e-999 9223372036854775807 9223372036854775808"
    " -9223372036854775809 0x8000000000000000 0x1.8p1 0x.8 0x1p 0x1p9999 .inf +.inf -.inf .INF"
    " .iNf .nan +.nan -.nan inf -Infinity nan NaN nan(x) 1e 1e+ 1.2.3 0b1 0o7 1d a/b 1:30 é"
    " \"7\" 'on' \"\" '' --"
)
SCALARS = st.sampled_from(
    [*_SCALARS.split(" "), "a:b", "!!str 7", "!!int x", "$(var x)", "&a b", r'"\x41"']
)
NAMES = st.sampled_from(
    [
        "a",
        "b",
        "a.b",
        "a.c",
        "p",
        "ros__parameters",
        "ros__parameters2",
        "1",
        "q.r.s",
        '"x y"',
        "''",
    ]
)
_KEYS = (
    "a /a ns ns/a /ns /** /* ** * /**/a /ns/** /ns/* /*/a /x/**/a //a a/ a//b a* /a*/b 1a a.b /"
    " ros__parameters"
)
KEYS = st.sampled_from(_KEYS.split(" "))
VALUES = st.recursive(
    SCALARS,
    lambda inner: st.one_of(
        st.lists(inner, max_size=4).map(lambda items: f"[{', '.join(items)}]"),
        st.lists(st.tuples(NAMES, inner), max_size=3).map(lambda pairs: _mapping(pairs)),
    ),
    max_leaves=6,
)
PARAMETERS = st.lists(st.tuples(NAMES, VALUES), max_size=5).map(lambda pairs: _mapping(pairs))
NODES = st.recursive(
    PARAMETERS.map(lambda text: f"{{ros__parameters: {text}}}"),
    lambda inner: st.lists(st.tuples(KEYS, inner), max_size=3).map(lambda pairs: _mapping(pairs)),
    max_leaves=4,
)
FILES = st.lists(st.tuples(KEYS, NODES), max_size=4).map(
    lambda pairs: "".join(f"{key}: {below}\n" for key, below in pairs)
)


def _mapping(pairs: list[tuple[str, str]]) -> str:
    return f"{{{', '.join(f'{name}: {value}' for name, value in pairs)}}}"


def ours(*texts: str) -> rcl_yaml.Read | None:
    """Read files as deros does."""
    overrides: Overrides[None] = Overrides()
    try:
        for text in texts:
            overrides.read(events(SourceFile("x.yaml", text)), None)
    except NotReadable:
        return None
    sections = [slot.section() for slot in overrides.slots]
    return [(each.key, [(v.name, v.value) for v in each.values]) for each in sections]


def _same(folder: Path, *texts: str) -> None:
    files = [folder / f"{number}.yaml" for number in range(len(texts))]
    for file, text in zip(files, texts, strict=True):
        file.write_text(text, encoding="utf-8")
    expected, found = rcl_yaml.read(*files), ours(*texts)
    assert repr(found) == repr(expected), texts  # by their texts: nan equals nan, 1 is not 1.0


@settings(max_examples=400, deadline=None, suppress_health_check=list(HealthCheck))
@given(files=st.lists(FILES, min_size=1, max_size=3))
@example(["a: {ros__parameters: {a.c: 1, a: {c: 2}, a.c: 3}}"])
@example(["a: {ros__parameters: {x: true}}", "a: {ros__parameters: {x: 5}}"])
@example(
    [
        "/**: {ros__parameters: {x: 1}}\na: {ros__parameters: {x: 2}}",
        "/**: {ros__parameters: {x: 3}}",
    ]
)
def test_files_mean_what_they_mean_to_ros(
    tmp_path_factory: pytest.TempPathFactory, files: list[str]
) -> None:
    """Keys, names, types and values, their order, and what is refused are the same."""
    _same(tmp_path_factory.mktemp("files"), *files)


@settings(max_examples=150, deadline=None, suppress_health_check=list(HealthCheck))
@given(text=st.text("ab:{}[],&*!|>'\"#%- \n\t?/.0rospameters_", max_size=60))
def test_broken_files_are_refused_alike(
    tmp_path_factory: pytest.TempPathFactory, text: str
) -> None:
    """What is no YAML to one of the two is none to the other."""
    _same(tmp_path_factory.mktemp("broken"), text)


@pytest.mark.parametrize(
    "text",
    [
        "a:\n  ros__parameters:\n    x: |-\n      7\n    y: >\n      on\n    z: |2-\n        8\n",
        "a:\n  ros__parameters:\n    x: 1\n---\nb:\n  ros__parameters:\n    x: 2\n",
        "%YAML 1.1\n---\na: {ros__parameters: {x: 010}}\n",
        "ns:\n  sub:\n    a:\n      ros__parameters: {x: 1}\n  b:\n    ros__parameters: {x: 2}\n"
        "c:\n  ros__parameters: {x: 3}\n",
        "a:\r\n  ros__parameters:\r\n    x: 1\r\n",
        "",
        "# nothing\n",
    ],
)
def test_layouts_are_read_alike(tmp_path: Path, text: str) -> None:
    """Blocks, documents, nested namespaces and line ends."""
    _same(tmp_path, text)


def test_positions_are_those_of_names_and_values() -> None:
    """A value points at its last name and at itself, a section at each of its keys."""
    text = "é:\n  a:\n    ros__parameters:\n      p: {q: [1, 2], r: 'x'}\n"
    source = SourceFile("x.yaml", text)
    overrides: Overrides[None] = Overrides()
    with pytest.raises(NotReadable) as refused:
        overrides.read(events(source), None)
    assert refused.value.fault.span.text == "a"
    source = SourceFile("x.yaml", text.replace("é:", "n:") + "n/a:\n  ros__parameters: {s: 1}\n")
    overrides = Overrides()
    overrides.read(events(source), None)
    (section,) = (each.section() for each in overrides.slots)
    assert [each.text for each in section.spans] == ["a", "n/a"]
    texts = [(v.name, v.name_span.text, v.value_span.text) for v in section.values]
    assert texts == [("p.q", "q", "1, 2"), ("p.r", "r", "'x'"), ("s", "s", "1")]
