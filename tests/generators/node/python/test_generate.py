"""The Python target: rejected nodes, and translation of single constructs to rclpy."""

from __future__ import annotations

import re
from dataclasses import replace
from pathlib import Path
from xml.etree import ElementTree

import pytest
import yaml
from hypothesis import given, settings
from hypothesis import strategies as st

from deros.generators.api.protocol import GenerationError
from deros.generators.node.python.generate import generate, package_files
from tests.support.generating import output_of
from tests.support.node_targets import files_of, node_of, refusal
from tests.support.profiles import scaled


def base_for(sections: str) -> str:
    """Return the base class of a node with these sections."""
    files = files_of(generate, f"node a_node : a_package {sections}")
    return files["a_package/a_package/a_node_base.py"].text


# Rejected nodes -----------------------------------------------------------------------------------


def test_modules_of_one_package_must_not_collide(tmp_path: Path) -> None:
    """A node cannot have the name of another node's base module."""
    (tmp_path / "a.rnd").write_text("node a : b")
    (tmp_path / "a_base.rnd").write_text("node a_base : b")
    with pytest.raises(GenerationError, match="'a_base' in the modules of package b"):
        output_of(generate, tmp_path / "a.rnd")


def test_package_name_must_be_a_valid_module() -> None:
    """A package named by a Python keyword cannot be imported."""
    assert refusal(generate, "node a\n: class")[::2] == ("DRS402", 2)


# Single constructs --------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("qos", "expression"),
    [
        ("", "10"),
        ("qos sensor_data", "qos_profile_sensor_data"),
        ("qos system_default", "qos_profile_system_default"),
        ("qos depth 3", "QoSProfile(depth=3)"),
        ("qos keep_all", "QoSProfile(history=HistoryPolicy.KEEP_ALL)"),
        ("qos reliable", "QoSProfile(reliability=ReliabilityPolicy.RELIABLE, depth=10)"),
        (
            "qos sensor_data depth 1",
            "QoSProfile(reliability=ReliabilityPolicy.BEST_EFFORT, depth=1)",
        ),
        (
            "qos depth 1 deadline 100 ms",
            "QoSProfile(depth=1, deadline=Duration(nanoseconds=100000000))",
        ),
    ],
)
def test_qos_is_translated_as_stated(qos: str, expression: str) -> None:
    """Presets, policies and combinations become the matching rclpy profile."""
    text = base_for(f"publishes topic x : std_msgs.Bool {qos}")
    compact = "".join(text.split()).replace(",)", ")")
    report = "event_callbacks=report.of_publishers"
    wanted = f"self.create_publisher(Bool, 'x', {expression}, {report})"
    assert wanted.replace(" ", "") in compact


@pytest.mark.parametrize(
    ("declaration", "declared"),
    [
        ("double = 1", "self.declare_parameter('x', 1.0)"),
        ("int = 1", "self.declare_parameter('x', 1)"),
        ("bool = true", "self.declare_parameter('x', True)"),
        ('string = "a\'b"', "self.declare_parameter('x', \"a'b\")"),
        ("double[] = [1, 2.5]", "self.declare_parameter('x', [1.0, 2.5])"),
        ("byte[] = [0, 255]", "self.declare_parameter('x', [b'\\x00', b'\\xff'])"),
        ("int[] = []", "self.declare_parameter('x', Parameter.Type.INTEGER_ARRAY)"),
        ("double", "self.declare_parameter('x', Parameter.Type.DOUBLE)"),
    ],
)
def test_defaults_have_the_declared_type(declaration: str, declared: str) -> None:
    """An integer written for a double is declared as a double, and so on."""
    assert declared in base_for(f"parameters name x : {declaration}")


@pytest.mark.parametrize(
    ("interval", "bounds"),
    [
        ("[1, 9]", (1, 9)),
        ("(1, 9)", (2, 8)),
        ("(0.5, 8.5]", (1, 8)),
        ("[-1e30, 1e30]", (-(2**63), 2**63 - 1)),
    ],
)
def test_open_integer_bounds_are_exact(interval: str, bounds: tuple[int, int]) -> None:
    """The closed range of a descriptor contains exactly the integers of the interval."""
    text = base_for(f"parameters name x : int = 5 in {interval}")
    bounds_in_text = re.search(r"IntegerRange\(\s*from_value=(\S+),\s*to_value=([-\d]+)", text)
    assert bounds_in_text is not None
    assert (int(bounds_in_text[1]), int(bounds_in_text[2])) == bounds
    assert "_CONSTRAINTS" not in text


def test_topic_parameter_is_read_only() -> None:
    """The port reads its parameter at the start; later changes are rejected."""
    text = base_for('parameters name t : string = "/a" subscribes topic x : std_msgs.Bool via t')
    assert "Bool, self.parameters.t or 'x', self.on_x, 10, " in " ".join(text.split())
    assert "self.declare_parameter('t', '/a', ParameterDescriptor(read_only=True))" in text


def test_list_of_topics_has_a_subscription_for_each() -> None:
    """All call one handler; the list is read at the start."""
    text = base_for("parameters name t : string[] = [] subscribes topic x : std_msgs.Bool via t")
    text = " ".join(text.split())
    assert (
        "for topic in self.parameters.t: self.create_subscription( Bool, topic, self.on_x," in text
    )
    assert "'t', Parameter.Type.STRING_ARRAY, ParameterDescriptor(read_only=True)" in text


def test_handler_says_that_silence_has_to_stop_the_node() -> None:
    """What stops the node is the author's code."""
    text = base_for("subscribes topic x : std_msgs.Bool stops after 1500 ms")
    assert "The node has to stop where no message comes for 1500 ms." in text


MAP = "parameters name s : string[] name {} : string subscribes topic x : std_msgs.Bool via {}"


def test_map_of_topics_has_a_subscription_for_each_name() -> None:
    """The handler is given the entry; the names are read at the start."""
    text = " ".join(base_for(MAP.format(*["to.<s>.t"] * 2)).split())
    assert "to.{entry}.t', Parameter.Type.STRING, ParameterDescriptor(read_only=True)" in text
    assert (
        "for entry, value in self.parameters.to.items(): if value.t: self.create_subscription("
        " Bool, value.t, partial(self.on_x, entry), 10," in text
    )
    assert "def on_x(self, entry: str, msg: Bool) -> None:" in text


def test_map_of_topics_without_further_parameters_has_the_names_as_values() -> None:
    """There is no structure around the only value."""
    text = " ".join(base_for(MAP.format(*["to.<s>"] * 2)).split())
    assert "self.parameters.to.items(): if value: self.create_subscription( Bool, value," in text


def test_handler_of_a_map_of_topics_runs_only_while_the_node_is_active() -> None:
    """As every handler of a managed node."""
    text = base_for("lifecycle " + MAP.format(*["to.<s>"] * 2))
    assert "self._while_active(partial(self.on_x, entry))," in text


def test_message_types_of_one_name_are_distinguished() -> None:
    """Two packages may have one type name, and a type may be named like the node's class."""
    text = base_for(
        "publishes topic x : a_msgs.State topic y : b_msgs.State topic z : c_msgs.ANode"
    )
    assert "from a_msgs.msg import State as AMsgsState" in text
    assert "from b_msgs.msg import State as BMsgsState" in text
    assert "from c_msgs.msg import ANode as CMsgsANode" in text


def test_generated_names_do_not_hide_names_of_rclpy() -> None:
    """No attribute of rclpy's nodes has a prefix of the generated methods."""
    from rclpy.lifecycle import LifecycleNode

    prefixes = (
        "publish_",
        "handle_",
        "call_",
        "client_",
        "accept_",
        "execute_",
        "cancel_",
        "send_",
    )
    timers_and_fields = ("timer_", "_publisher_", "_action_")
    assert [n for n in dir(LifecycleNode) if n.startswith(prefixes + timers_and_fields)] == []
    hooks = {n for n in dir(LifecycleNode) if n.startswith("on_")}
    assert hooks == {
        f"on_{n}" for n in ("activate", "cleanup", "configure", "deactivate", "error", "shutdown")
    }


@pytest.mark.ros
@pytest.mark.parametrize(
    "parameters",
    [
        "name x : double",
        "name x : int[] = [] name y : byte[] = [1]",
        "name x : double = 1e-7 name y : double[] = [1, -2.5e300]",
        'name x : string = "true" name y : string = "\\\\ \\" ü" name z.z : bool = false',
    ],
)
def test_ros_reads_every_parameter_file(parameters: str, tmp_path: Path) -> None:
    """The parser of ROS 2 accepts the file, even without a value."""
    import rclpy
    from rclpy.context import Context as RosContext

    files = files_of(generate, f"node a_node : a_package parameters {parameters}")
    (tmp_path / "a.yaml").write_text(files["a_package/config/a_node.yaml"].text)
    context = RosContext()
    rclpy.init(args=["--ros-args", "--params-file", str(tmp_path / "a.yaml")], context=context)
    context.shutdown()


# Any text -----------------------------------------------------------------------------------------


@settings(max_examples=scaled(25))
@given(description=st.text(max_size=200), default=st.text(max_size=40))
def test_any_text_gives_well_formed_files(description: str, default: str) -> None:
    """With any text in the model, Python compiles, XML parses, and YAML keeps the default."""
    model = node_of('node a : b parameters name x : string = "" publishes topic y : std_msgs.Bool')
    (parameter,), (port,) = model.parameters, model.ports
    model = replace(
        model,
        description=description,
        parameters=(replace(parameter, description=description, default=default),),
        ports=(replace(port, description=description),),
    )
    files = package_files([model], {"maintainer": "J <j@example.org>"})
    for path, file in files.items():
        if path.endswith(".py"):
            compile(file.text, path, "exec")
    ElementTree.fromstring(files["b/package.xml"].text)
    config = yaml.safe_load(files["b/config/a.yaml"].text)
    assert config["/**"]["ros__parameters"] == {"x": default}
