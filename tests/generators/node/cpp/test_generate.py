"""The C++ target: rejected nodes, and translation of single constructs to rclcpp."""

from __future__ import annotations

import re
from dataclasses import replace
from pathlib import Path
from xml.etree import ElementTree

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from deros.generators.api.protocol import Files, GenerationError, Owner
from deros.generators.node.cpp.generate import generate, package_files
from deros.generators.node.cpp.view import Provided
from deros.generators.output.writer import write
from deros.interfaces.store import InterfaceStore
from tests.support.cpp_lint import assert_cpp_lint_clean
from tests.support.generating import output_of
from tests.support.needs import may_run
from tests.support.node_targets import files_of, node_of, refusal
from tests.support.profiles import scaled


def base_for(sections: str) -> str:
    """Return the source of the base class of a node with these sections, on one line."""
    files = files_of(generate, f"node a_node : a_package {sections}")
    return " ".join(files["a_package/src/a_node_base.cpp"].text.split())


# Rejected nodes -----------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("sections", "name"),
    [
        ("publishes topic _x : std_msgs.Bool\ntopic /x : std_msgs.Bool", "publish_x"),
        ("parameters name a__b : double = 1.0\nname a_b : double = 1.0", "a_b"),
    ],
)
def test_names_that_differ_only_in_underscores_collide(sections: str, name: str) -> None:
    """C++ reserves many names with underscores: leading, trailing and repeated ones are dropped."""
    code, message, line = refusal(generate, f"node a : b {sections}")
    assert (code, line) == ("DRS401", 2)
    assert repr(name) in message


@pytest.mark.parametrize(
    ("name", "other", "within"),
    [
        ("a", "a_main", "'a_main' in the sources of package b"),
        ("a", "A", "'a' and 'A' in the sources of package b, which differ only in case"),
        ("a_b", "aB", "'AB' in the namespace b"),
    ],
)
def test_nodes_of_one_package_must_not_collide(
    name: str, other: str, within: str, tmp_path: Path
) -> None:
    """Two nodes share neither a file nor a class."""
    (tmp_path / "own.rnd").write_text(f"node {name} : b")
    (tmp_path / "other.rnd").write_text(f"node {other} : b")
    with pytest.raises(GenerationError, match=within):
        output_of(generate, tmp_path / "own.rnd")


@pytest.mark.parametrize("package", ["namespace", "std"])
def test_package_name_must_be_a_valid_namespace(package: str) -> None:
    """A C++ keyword or the name of the standard library cannot contain the class."""
    assert refusal(generate, f"node a\n: {package}")[::2] == ("DRS402", 2)


# Single constructs --------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("qos", "expression"),
    [
        ("", "10"),
        ("qos sensor_data", "rclcpp::SensorDataQoS()"),
        ("qos system_default", "rclcpp::SystemDefaultsQoS()"),
        ("qos depth 3", "rclcpp::QoS(3)"),
        ("qos keep_all", "rclcpp::QoS(rclcpp::KeepAll())"),
        ("qos best_effort volatile", "rclcpp::QoS(10).best_effort().durability_volatile()"),
        ("qos sensor_data depth 1", "rclcpp::SensorDataQoS().keep_last(1)"),
        (
            "qos depth 1 deadline 100 ms",
            "rclcpp::QoS(1).deadline(rclcpp::Duration::from_nanoseconds(100000000))",
        ),
    ],
)
def test_qos_is_translated_as_stated(qos: str, expression: str) -> None:
    """Presets, policies and combinations become the matching rclcpp profile."""
    text = base_for(f"publishes topic x : std_msgs.Bool {qos}").replace("( ", "(")
    assert (
        f'create_publisher<std_msgs::msg::Bool>("x", {expression}, report.publisher("x"));' in text
    )


@pytest.mark.parametrize(
    ("declaration", "declared", "field"),
    [
        ("double = 1", "rclcpp::ParameterValue(1.0)", "double x{1.0};"),
        ("int = 1", "rclcpp::ParameterValue(int64_t{1})", "int64_t x{1};"),
        ("bool = true", "rclcpp::ParameterValue(true)", "bool x{true};"),
        ('string = "a\'b"', 'rclcpp::ParameterValue("a\'b")', 'std::string x{"a\'b"};'),
        (
            "double[] = [1, 2.5]",
            "rclcpp::ParameterValue(std::vector<double>{1.0, 2.5})",
            "std::vector<double> x{1.0, 2.5};",
        ),
        (
            "byte[] = [0, 255]",
            "rclcpp::ParameterValue(std::vector<uint8_t>{0, 255})",
            "std::vector<uint8_t> x{0, 255};",
        ),
        ("double", "rclcpp::ParameterType::PARAMETER_DOUBLE", "double x{};"),
    ],
)
def test_defaults_have_the_declared_type(declaration: str, declared: str, field: str) -> None:
    """An integer written for a double is declared as a double, and so on."""
    files = files_of(generate, f"node a : b parameters name x : {declaration}")
    assert f'declare_parameter("x", {declared});' in files["b/src/a_base.cpp"].text
    assert f" {field}\n" in files["b/include/b/a_base.hpp"].text


@pytest.mark.parametrize(
    ("interval", "bounds"),
    [
        ("[1, 9]", ("1", "9")),
        ("(1, 9)", ("2", "8")),
        ("(0.5, 8.5]", ("1", "8")),
        ("[-1e30, 1e30]", ("std::numeric_limits<int64_t>::min()", "INT64_C(9223372036854775807)")),
    ],
)
def test_open_integer_bounds_are_exact(interval: str, bounds: tuple[str, str]) -> None:
    """The closed range of a descriptor contains exactly the integers of the interval."""
    text = base_for(f"parameters name x : int = 5 in {interval}")
    assert f"integer_range[0].from_value = {bounds[0]};" in text
    assert f"integer_range[0].to_value = {bounds[1]};" in text
    assert "violated" not in text


def test_topic_parameter_is_read_only() -> None:
    """The port reads its parameter at the start; later changes are rejected."""
    text = base_for('parameters name t : string = "/a" subscribes topic x : std_msgs.Bool via t')
    assert 'parameters_->t.empty() ? "x" : parameters_->t, 10,' in text
    assert (
        'about.read_only = true; declare_parameter("t", rclcpp::ParameterValue("/a"), about)'
        in text
    )


def test_list_of_topics_has_a_subscription_for_each() -> None:
    """All call one handler; the list is read at the start."""
    text = base_for("parameters name t : string[] = [] subscribes topic x : std_msgs.Bool via t")
    assert "for (const auto & topic : parameters_->t) { subscriptions_x_.push_back(" in text
    assert "about.read_only = true;" in text


MAP = "parameters name s : string[] name {} : string subscribes topic x : std_msgs.Bool via {}"


@pytest.mark.parametrize(("name", "topic"), [("to.<s>.t", "value.t"), ("to.<s>", "value")])
def test_map_of_topics_has_a_subscription_for_each_name(name: str, topic: str) -> None:
    """The handler is given the entry; the names are read at the start."""
    text = base_for(MAP.format(name, name))
    assert (
        f"for (const auto & [entry, value] : parameters_->to) {{ if ({topic}.empty()) {{ continue;"
        " } subscriptions_x_.push_back( create_subscription<std_msgs::msg::Bool>("
        f" {topic}, 10, [this, entry = entry](const std_msgs::msg::Bool & msg) {{"
        " on_x(entry, msg); }," in text
    )
    assert text.count("about.read_only = true;") == 2


@pytest.mark.parametrize(
    ("name", "header"),
    [
        ("LaserScan", "laser_scan"),
        ("NavSatFix", "nav_sat_fix"),
        ("CompressedImage", "compressed_image"),
        ("UInt8MultiArray", "u_int8_multi_array"),
        ("Float64", "float64"),
        ("IMUData2D", "imu_data2_d"),
    ],
)
def test_header_names_follow_rosidl(name: str, header: str) -> None:
    """A type name in mixed case becomes a header name by the rule of the interface generators."""
    files = files_of(generate, f"node a : b publishes topic x : some_msgs.{name}")
    assert f'#include "some_msgs/msg/{header}.hpp"' in files["b/include/b/a_base.hpp"].text


def test_headers_of_common_packages_exist() -> None:
    """Every type of the common message packages has its header at the computed path."""
    from deros.generators.text.cpp import cpp_header
    from deros.interfaces.types import InterfaceType
    from tests.support.cpp import message_flags

    folders = [Path(flag) for flag in message_flags() if flag != "-isystem"]
    store = InterfaceStore()
    for package in ("std_msgs", "sensor_msgs", "geometry_msgs", "diagnostic_msgs", "nav_msgs"):
        for name in store.names(package, "msg"):
            header = cpp_header(InterfaceType(package, "msg", name))
            assert any((folder / header).is_file() for folder in folders), header


# Nodes of other generators ------------------------------------------------------------------------


def test_external_node_is_constructed_by_its_class() -> None:
    """Its sources are built, no file is a user file, and ports are opened on demand."""
    model = node_of(
        "node guard_cpp : b parameters name x : int = 1 subscribes topic y : std_msgs.Bool "
        "services service z : std_srvs.Trigger"
    )
    provided = Provided(
        ("src/guard.cpp", "src/logic.c"),
        needs=("diagnostic_msgs",),
        default_name="guard",
        memory="b::Pool",
        includes=("b/pool.hpp",),
    )
    files = package_files([model], {}, {"guard_cpp": provided})
    users = [path for path, file in files.items() if file.owner is Owner.USER]
    assert users == ["b/package.xml"]
    source = " ".join(files["b/src/guard_base.cpp"].text.split())
    assert ': Node("guard", options) { declare_parameters();' in source
    assert "GuardBase::open_ports(const rclcpp::CallbackGroup::SharedPtr & group)" in source
    assert "in_group, std::make_shared<b::Pool<std_msgs::msg::Bool>>());" in source
    assert "rclcpp::ServicesQoS(), group);" in source
    assert '#include "b/pool.hpp"' in source
    cmake = " ".join(files["b/CMakeLists.txt"].text.split())
    assert "SHARED src/guard.cpp src/guard_base.cpp src/logic.c )" in cmake
    assert "${diagnostic_msgs_TARGETS}" in cmake
    assert "set_target_properties(guard_cpp_program PROPERTIES OUTPUT_NAME guard_cpp)" in cmake
    assert "std::make_shared<b::Guard>" in files["b/src/guard_main.cpp"].text
    assert "executable='guard_cpp'" in files["b/launch/guard_cpp.launch.py"].text


def test_external_node_may_have_its_own_main() -> None:
    """No other main is generated for it."""
    model = node_of("node guard : b")
    provided = Provided(("src/guard.cpp",), main=("src/own_main.cpp",))
    files = package_files([model], {}, {"guard": provided})
    assert "b/src/guard_main.cpp" not in files
    assert "add_executable(guard_program src/own_main.cpp )" in " ".join(
        files["b/CMakeLists.txt"].text.split()
    )


# Any text -----------------------------------------------------------------------------------------


@may_run("cppcheck")
def test_long_names_pass_the_linters(tmp_path: Path) -> None:
    """Names of maximum length and hostile descriptions still give a clean package."""
    long = "n" * 120
    text = (
        f'node talker : chat "Say \\\\d \\"\\"\\" and more, {"very " * 40}often TODO ??/"\n'
        f'parameters name {long} : string = "{long}" one_of ["{long}", "b"] "it\'s {long}"\n'
        f"publishes topic {long}/a : std_msgs.String\n"
        f'subscribes topic {long}/b : std_msgs.String via {long} qos sensor_data "about {long}"\n'
        f"services service {long} : std_srvs.Trigger\n"
        f"timers timer {long} every 3 ns\n"
    )
    write(files_of(generate, text), tmp_path)
    assert_cpp_lint_clean(tmp_path / "chat")


@settings(max_examples=scaled(25))
@given(description=st.text(max_size=200), default=st.text(max_size=40))
def test_any_text_gives_well_formed_files(description: str, default: str) -> None:
    """Any text leaves XML well-formed, and code outside comments and literals as it is."""
    model = node_of('node a : b parameters name x : string = "" publishes topic y : std_msgs.Bool')
    (parameter,), (port,) = model.parameters, model.ports

    def files_with(description: str, default: str) -> Files:
        described = replace(
            model,
            description=description,
            parameters=(replace(parameter, description=description, default=default),),
            ports=(replace(port, description=description),),
        )
        return package_files([described], {"maintainer": "J <j@example.org>"})

    files, plain = files_with(f"a{description}", default), files_with("a", "")
    ElementTree.fromstring(files["b/package.xml"].text)
    for path in ("b/include/b/a_base.hpp", "b/include/b/a.hpp", "b/src/a.cpp", "b/src/a_base.cpp"):
        assert _code(files[path].text) == _code(plain[path].text)


def _code(text: str) -> str:
    """Return the text without comments, white space and literals."""
    without = re.sub(r"^ *//.*$|  // NOLINT.*$", "", text, flags=re.MULTILINE)
    literals = re.sub(r'"(?:[^"\\\n]|\\.)*"', "TEXT", without)
    literals = re.sub(r"std::string\(TEXT, \d+\)", "TEXT", literals)
    return re.sub(r"(TEXT)+", "TEXT", re.sub(r"\s+|#include <string>", "", literals))
