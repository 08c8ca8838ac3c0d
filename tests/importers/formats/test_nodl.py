"""NoDL 2 as node descriptions."""

from __future__ import annotations

from pathlib import Path

import pytest
from hypothesis import event, given, settings

from deros.importers.formats.nodl import is_nodl
from deros.importers.readers import UnreadableError
from deros.models.common import Interval, QosProfile
from deros.models.node import PortKind
from tests.support.foreign import Become, become, damaged, survived

DOCUMENT = """\
nodl_version: 2
description: |
  Drives
  the base.
parameters:
  rate: {type: double, default_value: 10.0, validation: {bounds<>: [1, 100]}}
  raw: {type: byte_array, default_value: [0, 255]}
publishers:
  - name: /odom
    type: nav_msgs/msg/Odometry
    description: Where it is
    qos:
      history: KEEP_LAST
      depth: 5
      reliability: BEST_EFFORT
      durability: TRANSIENT_LOCAL
      deadline_ns: 250000000
      lifespan_ns: 0
      liveliness: MANUAL_BY_TOPIC
      liveliness_lease_duration_ns: 2000000000
subscriptions:
  - name: cmd_vel
    type: geometry_msgs/Twist
    qos: {history: KEEP_ALL, reliability: RELIABLE}
  - name: ~/hold
    type: std_msgs/msg/Bool
    qos: {history: SYSTEM_DEFAULT, reliability: SYSTEM_DEFAULT}
service_servers:
  - {name: reset, type: std_srvs/srv/Trigger}
service_clients:
  - name: /map
    type: nav_msgs/srv/GetMap
    qos: {history: KEEP_LAST, depth: 3, reliability: RELIABLE}
action_servers:
  - {name: count, type: example_interfaces/Fibonacci}
action_clients:
  - {name: other/count, type: example_interfaces/action/Fibonacci}
"""


def document(folder: Path, text: str, name: str = "base.nodl.yaml") -> Become:
    """Return what a document becomes."""
    path = folder / name
    path.write_text(text, encoding="utf-8")
    return become(path)


def test_a_document_becomes_a_node_that_checks_clean(tmp_path: Path) -> None:
    """The name is that of the file; ports, QoS, parameters and descriptions are those in it."""
    made = document(tmp_path, DOCUMENT)
    assert (made.findings, made.missing) == ([], ())
    node = made.node
    assert (node.name, node.package, node.description) == (
        "base",
        "unknown_package",
        "Drives the base.",
    )
    assert [(each.kind, each.name, str(each.type), each.qos) for each in node.ports] == [
        (
            PortKind.PUBLISHER,
            "/odom",
            "nav_msgs/msg/Odometry",
            QosProfile(
                reliability="best_effort",
                durability="transient_local",
                depth=5,
                deadline_ns=250_000_000,
                liveliness="manual_by_topic",
                lease_ns=2_000_000_000,
            ),
        ),
        (
            PortKind.SUBSCRIPTION,
            "cmd_vel",
            "geometry_msgs/msg/Twist",
            QosProfile(reliability="reliable", keep_all=True),
        ),
        (
            PortKind.SUBSCRIPTION,
            "~/hold",
            "std_msgs/msg/Bool",
            QosProfile(preset="system_default"),
        ),
        (PortKind.SERVICE, "reset", "std_srvs/srv/Trigger", None),
        (
            PortKind.CLIENT,
            "/map",
            "nav_msgs/srv/GetMap",
            QosProfile(reliability="reliable", depth=3),
        ),
        (PortKind.ACTION, "count", "example_interfaces/action/Fibonacci", None),
        (PortKind.ACTION_CLIENT, "other/count", "example_interfaces/action/Fibonacci", None),
    ]
    assert node.ports[0].description == "Where it is"
    rate, raw = node.parameters
    assert (rate.default, rate.interval) == (10.0, Interval(1, 100))
    assert (raw.type.value, raw.default) == ("byte[]", (0, 255))


def test_json_is_read_too(tmp_path: Path) -> None:
    """Documents are YAML or JSON."""
    text = '{"nodl_version": 2, "publishers": [{"name": "a", "type": "std_msgs/Bool"}]}'
    made = document(tmp_path, text, "base.nodl.json")
    assert (made.findings, made.missing) == ([], ())
    assert [each.name for each in made.node.ports] == ["a"]


@pytest.mark.parametrize(
    ("manifest", "package"),
    [
        ("<package><name>base_driver</name></package>", "base_driver"),
        ("<package><name> base_driver\n</name></package>", "base_driver"),
        ("<package><name>x</name></package>", "unknown_package"),
        ("<package/>", "unknown_package"),
    ],
)
def test_the_package_is_that_of_the_folder(manifest: str, package: str, tmp_path: Path) -> None:
    """A document does not name it: the manifest above it does."""
    (tmp_path / "package.xml").write_text(manifest, encoding="utf-8")
    (tmp_path / "nodl").mkdir()
    assert document(tmp_path / "nodl", "nodl_version: 2\n").node.package == package


def test_included_documents_are_of_the_node(tmp_path: Path) -> None:
    """Each once, also where they include one another; others are listed."""
    ports = "publishers: [{name: NAME, type: std_msgs/msg/Bool}]\n"
    include = "include: [{ref: local://b.yaml}, {ref: local://c.yaml}, {ref: nodl://p_q/x}]\n"
    (tmp_path / "b.yaml").write_text(
        "nodl_version: 2\ninclude: [{ref: local://base.nodl.yaml}, {ref: local://c.yaml}]\n"
        + ports.replace("NAME", "b"),
        encoding="utf-8",
    )
    (tmp_path / "c.yaml").write_text("nodl_version: 2\n" + ports.replace("NAME", "c"), "utf-8")
    made = document(tmp_path, "nodl_version: 2\n" + include + ports.replace("NAME", "a"))
    assert made.findings == []
    assert [each.name for each in made.node.ports] == ["c", "b", "a"]
    assert made.missing == (
        "b.yaml:2: document 'local://base.nodl.yaml' is left out: it is included already",
        "base.nodl.yaml:2: document 'local://c.yaml' is left out: it is included already",
        "base.nodl.yaml:2: document 'nodl://p_q/x' is left out: give the document of that package, "
        "in place of the reference",
    )


@pytest.mark.parametrize(
    ("ref", "said"),
    [
        ("local://none.yaml", "there is no such file"),
        ('"local://a\\0b"', "there is no such file"),
        ("local://.", "there is no such file"),
        ("3", "give the document of that package"),
    ],
)
def test_a_reference_to_nothing_is_listed(ref: str, said: str, tmp_path: Path) -> None:
    """The rest of the document is read."""
    made = document(tmp_path, f"nodl_version: 2\ninclude: [{{ref: {ref}}}]\n")
    assert made.findings == []
    assert [said in each for each in made.missing] == [True]


def test_a_chain_of_documents_ends(tmp_path: Path) -> None:
    """A node of more than fifty documents is none that people write."""
    for number in range(60):
        text = f"nodl_version: 2\ninclude: [{{ref: local://d{number + 1}.nodl.yaml}}]\n"
        (tmp_path / f"d{number}.nodl.yaml").write_text(text, encoding="utf-8")
    made = become(tmp_path / "d0.nodl.yaml")
    assert "50 documents are read already" in made.missing[-1]


@pytest.mark.parametrize(
    ("lines", "said"),
    [
        ("codegen: {cpp: {}}", "'codegen' is left out: it is for generators of code"),
        ("timers: []", "'timers' is left out: it is not known"),
        ("publishers: {a: 1}", "'publishers' has no list"),
        ("publishers: [a]", "an entry of 'publishers' has no keys"),
        ("publishers: [{name: a}]", "'' is no type of a publisher"),
        ("publishers: [{name: a, type: std_msgs/srv/Bool}]", "is no type of a publisher"),
        ("publishers: [{name: a b, type: std_msgs/Bool}]", "ROS 2 rejects the name 'a b'"),
        ("publishers: [{name: a, type: std_msgs/None}]", "publisher 'a' is left out: package"),
        ("publishers: [{name: a, type: std_msgs/Bool, rate: 3}]", "has 'rate'"),
        ("publishers: [{name: a, type: std_msgs/Bool, qos: 3}]", "has a 'qos' without policies"),
        (
            "publishers: [{name: a, type: std_msgs/Bool}, {name: /a, type: std_msgs/Bool}]",
            "declared twice",
        ),
        ("parameters: [a]", "'parameters' has no keys"),
        ("parameters: {a: 3}", "parameter 'a' is left out: nothing is said of it"),
        ("parameters: {a<b>: {type: int}}", "a name has no '<' or '>'"),
        ("parameters: {a: {type: none}}", "type 'none' is for documents only"),
    ],
)
def test_what_a_model_cannot_say_is_listed(lines: str, said: str, tmp_path: Path) -> None:
    """With file and line."""
    made = document(tmp_path, f"nodl_version: 2\n{lines}\n")
    assert made.findings == []
    assert any(each.startswith("base.nodl.yaml:2: ") and said in each for each in made.missing)


@pytest.mark.parametrize(
    ("policy", "said"),
    [
        ("history: SYSTEM_DEFAULT, reliability: RELIABLE", "'history: SYSTEM_DEFAULT', which is"),
        ("reliability: BEST_AVAILABLE", "'reliability: BEST_AVAILABLE', which is the default"),
        ("reliability: reliable", "'reliability: reliable', which is not known"),
        ("history: KEEP_ALL, depth: 3", "'depth: 3', which means nothing beside KEEP_ALL"),
        ("depth: 0", "'depth: 0', which is not known"),
        ("depth: [1]", "'depth: None', which is not known"),
        ("deadline_ns: 9223372036854775807", "'deadline_ns: 9223372036854775807', which is not"),
        ("deadline_ns: 1.5", "'deadline_ns: 1.5', which is not known"),
        ("lease: 3", "'lease: 3', which is not known"),
    ],
)
def test_policies_that_a_model_has_not_are_listed(policy: str, said: str, tmp_path: Path) -> None:
    """The port stays."""
    line = f"publishers: [{{name: a, type: std_msgs/Bool, qos: {{{policy}}}}}]"
    made = document(tmp_path, f"nodl_version: 2\n{line}\n")
    assert made.findings == []
    assert [said in each for each in made.missing] == [True], made.missing
    assert [each.name for each in made.node.ports] == ["a"]


@pytest.mark.parametrize(
    ("name", "text", "is_one"),
    [
        ("a.nodl.yaml", "", True),
        ("a.nodl.json", "{}", True),
        ("a.nodl.xml", "<interface/>", True),
        ("a.yaml", "nodl_version: 3\n", True),
        ("a.yaml", "publishers: []\n", False),
        ("a.txt", "nodl_version: 2\n", False),
    ],
)
def test_a_document_is_known_by_its_name_or_version(
    name: str, text: str, is_one: bool, tmp_path: Path
) -> None:
    """Any version of NoDL: what cannot be read says so by itself."""
    (tmp_path / name).write_text(text, encoding="utf-8")
    assert is_nodl(tmp_path / name) is is_one


@pytest.mark.parametrize(
    ("name", "text", "said"),
    [
        ("a.nodl.xml", "<interface/>", "this is NoDL 1; documents of version 2 are YAML or JSON"),
        ("a.nodl.yaml", "publishers: []\n", "a.nodl.yaml:1: this is not NoDL of version 2"),
        ("a.nodl.yaml", "\nnodl_version: 3\n", "a.nodl.yaml:2: this is not NoDL of version 2"),
        ("a.nodl.yaml", "[]", "has no keys at its top"),
    ],
)
def test_other_versions_cannot_be_read(name: str, text: str, said: str, tmp_path: Path) -> None:
    """The error names the file, and the line where there is one."""
    with pytest.raises(UnreadableError, match=said):
        document(tmp_path, text, name)


@settings(deadline=None, max_examples=60)
@given(data=damaged(DOCUMENT))
def test_a_damaged_document_ends_in_a_clean_model_or_an_error(data: bytes) -> None:
    """Whatever stands in it."""
    event("models" if survived(data, "base.nodl.yaml", "nodl") else "error")
