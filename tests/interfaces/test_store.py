"""Lookup of interface definitions."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path

import pytest

from deros.interfaces.standard_services import OF_EVERY_NODE, OF_MANAGED_NODES
from deros.interfaces.store import InterfaceStore
from deros.interfaces.types import FieldType, InterfaceType

BOOL = InterfaceType("std_msgs", "msg", "Bool")
TRIGGER = InterfaceType("std_srvs", "srv", "Trigger")


def write(path: Path, text: str) -> None:
    """Write a file and create its parent folders."""
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_text(text, encoding="utf-8")


def install(prefix: Path, package: str, name: str, text: str) -> None:
    """Install one message as ament does: the index entry and the file in share."""
    write(prefix / "share/ament_index/resource_index/rosidl_interfaces" / package, f"msg/{name}\n")
    write(prefix / "share" / package / "msg" / f"{name}.msg", text)


@pytest.fixture
def embedded() -> InterfaceStore:
    """Create a store with only the embedded definitions."""
    return InterfaceStore(prefixes=())


def test_embedded_interfaces_are_known_without_ros(embedded: InterfaceStore) -> None:
    """The common interfaces are known without ROS 2 on the machine."""
    message = embedded.message(BOOL)
    assert message is not None
    assert message.fields == (("data", FieldType("bool")),)
    service = embedded.service(TRIGGER)
    assert service is not None
    assert [name for name, _ in service[1].fields] == ["success", "message"]
    action = embedded.action(InterfaceType("example_interfaces", "action", "Fibonacci"))
    assert action is not None
    assert [part.fields[0][0] for part in action] == ["order", "sequence", "sequence"]


def test_services_of_every_node_are_embedded(embedded: InterfaceStore) -> None:
    """A model may call them without ROS 2 on the machine."""
    for kind in (*OF_EVERY_NODE.values(), *OF_MANAGED_NODES.values()):
        if kind.package != "type_description_interfaces":
            assert embedded.service(kind), kind


def test_embedded_definitions_keep_bounds_constants_and_defaults(embedded: InterfaceStore) -> None:
    """The embedded definitions contain all that the checks need."""
    solid = embedded.message(InterfaceType("shape_msgs", "msg", "SolidPrimitive"))
    quaternion = embedded.message(InterfaceType("geometry_msgs", "msg", "Quaternion"))
    assert solid is not None
    assert solid.field("dimensions") == FieldType("float64", "bounded", 3)
    assert ("SPHERE", 2) in [(constant.name, constant.value) for constant in solid.constants]
    assert quaternion is not None
    assert quaternion.defaults["w"] == 1.0


def test_embedded_definitions_match_installed_jazzy(embedded: InterfaceStore) -> None:
    """Every interface in both places is the same in both."""
    installed = InterfaceStore(prefixes=[Path(sys.prefix)])
    pytest.importorskip("std_msgs")
    compared = 0
    for package in sorted(embedded.packages() - {"example_interfaces"}):
        for name in sorted(installed.names(package, "msg") & embedded.names(package, "msg")):
            kind = InterfaceType(package, "msg", name)
            assert embedded.message(kind) == installed.message(kind)
            compared += 1
        for name in sorted(installed.names(package, "srv") & embedded.names(package, "srv")):
            kind = InterfaceType(package, "srv", name)
            assert embedded.service(kind) == installed.service(kind)
            compared += 1
    assert compared > 100


def test_unknown_interface_is_none(embedded: InterfaceStore) -> None:
    """An unknown package, name or kind returns None and does not raise."""
    assert embedded.message(InterfaceType("no_such", "msg", "Bool")) is None
    assert not embedded.has_package("no_such")
    assert embedded.has_package("std_msgs")
    assert not embedded.exists(InterfaceType("std_msgs", "msg", "Bol"))
    assert embedded.message(TRIGGER) is None
    assert embedded.exists(TRIGGER)
    assert embedded.names("no_such", "msg") == frozenset()
    assert not embedded.has_package("")


@pytest.mark.parametrize("root", ["", "src", "src/deep/my_msgs", "src/deep/my_msgs/msg"])
def test_interface_folder_may_be_given_at_any_level(tmp_path: Path, root: str) -> None:
    """A workspace, a package and its msg folder all work as ``--interfaces``."""
    write(tmp_path / "src/deep/my_msgs/msg/Thing.msg", "int8 x\n")
    store = InterfaceStore([tmp_path / root], prefixes=())
    assert store.names("my_msgs", "msg") == {"Thing"}
    message = store.message(InterfaceType("my_msgs", "msg", "Thing"))
    assert message is not None
    assert message.field("x") == FieldType("int8")
    assert "my_msgs" in store.packages()
    assert "std_msgs" in store.packages()


def test_package_name_comes_from_package_xml(tmp_path: Path) -> None:
    """The folder of a checkout may have another name than the package."""
    write(tmp_path / "repo/msg/Thing.msg", "")
    write(tmp_path / "repo/package.xml", "<package><name>real_msgs</name></package>")
    store = InterfaceStore([tmp_path], prefixes=())
    assert store.exists(InterfaceType("real_msgs", "msg", "Thing"))
    assert not store.has_package("repo")


def test_first_location_of_a_package_defines_it(tmp_path: Path) -> None:
    """Folders hide the ament index, and the index the embedded definitions, per package."""
    write(tmp_path / "ws/std_msgs/msg/Bool.msg", "bool folder\n")
    install(tmp_path / "prefix", "std_msgs", "Int8", "int8 hidden\n")
    install(tmp_path / "prefix", "geometry_msgs", "Point", "int8 index\n")
    store = InterfaceStore([tmp_path / "ws"], prefixes=[tmp_path / "prefix"])
    message = store.message(BOOL)
    assert message is not None
    assert message.field("folder")
    assert not store.exists(InterfaceType("std_msgs", "msg", "Int8"))
    point = store.message(InterfaceType("geometry_msgs", "msg", "Point"))
    assert point is not None
    assert point.field("index")
    assert store.has_package("nav_msgs")


def test_prefixes_default_to_ament_prefix_path(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Missing prefixes in AMENT_PREFIX_PATH are ignored."""
    install(tmp_path, "my_msgs", "Thing", "int8 x\n")
    monkeypatch.setenv("AMENT_PREFIX_PATH", f"/no/such/prefix:{tmp_path}")
    store = InterfaceStore()
    assert store.exists(InterfaceType("my_msgs", "msg", "Thing"))
    assert "my_msgs" in store.packages()


def test_unreadable_definition_exists_with_a_problem(tmp_path: Path) -> None:
    """A faulty or binary file is distinguished from a missing one."""
    write(tmp_path / "my_msgs/msg/Bad.msg", "int8 x\nint8\n")
    (tmp_path / "my_msgs/msg/Binary.msg").write_bytes(b"\xff\xfe\x00")
    store = InterfaceStore([tmp_path], prefixes=())
    bad = InterfaceType("my_msgs", "msg", "Bad")
    assert store.exists(bad)
    assert store.message(bad) is None
    problem = store.problem(bad)
    assert problem is not None
    assert (Path(problem.path).name, problem.line) == ("Bad.msg", 2)
    binary = store.problem(InterfaceType("my_msgs", "msg", "Binary"))
    assert binary is not None
    assert "cannot be read" in binary.message
    assert store.problem(BOOL) is None


def test_installed_message_loads_no_heavy_modules(tmp_path: Path) -> None:
    """An installed message and a common unit import neither rosbags nor pint nor numpy."""
    install(tmp_path, "std_msgs", "Bool", "bool data\n")
    program = (
        "import sys; from pathlib import Path\n"
        "from deros import names\n"
        "from deros.interfaces import fields, rep103, store, types, units\n"
        f"found = store.InterfaceStore(prefixes=[Path({str(tmp_path)!r})])\n"
        "assert found.message(types.InterfaceType('std_msgs', 'msg', 'Bool'))\n"
        "assert units.UnitRegistry().parse('m/s^2')\n"
        "print([name for name in ('pint', 'numpy', 'rosbags') if name in sys.modules])\n"
    )
    result = subprocess.run(
        [sys.executable, "-c", program], capture_output=True, text=True, check=True
    )
    assert result.stdout == "[]\n"
