"""The built-in generators, as the entry points of deros declare them.

Each imports its module when it is called, so that listing the generators stays fast.
"""

from __future__ import annotations

from deros.generators.api.protocol import Context, Files, Option, Options
from deros.generators.api.registry import generator
from deros.models.node import NodeType
from deros.models.rules import Rules
from deros.models.system import System

_MAINTAINER = Option("maintainer", "maintainer for package.xml, as 'Jane Doe <jane@example.com>'")
_COPYRIGHT = Option("copyright", "years and holder for the files' headers, as '2026 Jane Doe'")
_LICENCE = Option("licence", "licence of the package, as 'BSD-3-Clause' (default: Apache-2.0)")


@generator("rosnode", "python", (_MAINTAINER, _COPYRIGHT, _LICENCE))
def rosnode_python(model: NodeType, context: Context, options: Options) -> Files:
    """A complete ament_python package: base class, your node, parameters, launch file, tests."""
    from deros.generators.node.python.generate import generate

    return generate(model, context, options)


@generator("rosnode", "cpp", (_MAINTAINER, _COPYRIGHT, _LICENCE))
def rosnode_cpp(model: NodeType, context: Context, options: Options) -> Files:
    """A complete ament_cmake package: base class, your node as a component, parameters, tests."""
    from deros.generators.node.cpp.generate import generate

    return generate(model, context, options)


@generator("rossystem", "launch")
def rossystem_launch(model: System, context: Context, options: Options) -> Files:
    """A ROS 2 launch file that starts every node with its parameters and remappings."""
    from deros.generators.system.launch.generate import generate

    return generate(model, context, options)


@generator("rossystem", "launch-xml")
def rossystem_launch_xml(model: System, context: Context, options: Options) -> Files:  # noqa: ARG001
    """The launch file in XML; what launch cannot say in it is refused."""
    from deros.generators.system.frontends.generate import generate

    return generate(model, "xml")


@generator("rossystem", "launch-yaml")
def rossystem_launch_yaml(model: System, context: Context, options: Options) -> Files:  # noqa: ARG001
    """The launch file in YAML; what launch cannot say in it is refused."""
    from deros.generators.system.frontends.generate import generate

    return generate(model, "yaml")


@generator("rossystem", "script")
def rossystem_script(model: System, context: Context, options: Options) -> Files:
    """The equivalent of the launch file as one Python file that needs only the standard library."""
    from deros.generators.system.script.generate import generate

    return generate(model, context, options)


@generator("rossystem", "params")
def rossystem_params(model: System, context: Context, options: Options) -> Files:
    """The parameters of every node as one ROS 2 parameter file (YAML)."""
    from deros.generators.system.params.generate import generate

    return generate(model, context, options)


_ENCLAVE = Option("enclave", "one enclave for all nodes, as '/robot' (default: one for each node)")


@generator("rossystem", "sros2", (_ENCLAVE,))
def rossystem_sros2(model: System, context: Context, options: Options) -> Files:
    """A policy for SROS2 with exactly the permissions that the wiring implies."""
    from deros.generators.system.sros2.generate import generate

    return generate(model, context, options)


_UNITS = (
    Option("setup", "setup file that units source (default: /opt/ros/jazzy/setup.bash)"),
    Option("arguments", "values of the system's arguments, as 'slam:=false robot:=r2'"),
)


@generator("rossystem", "systemd", _UNITS)
def rossystem_systemd(model: System, context: Context, options: Options) -> Files:
    """Units of systemd: a service for each node and process, and a target for the system."""
    from deros.generators.system.systemd.generate import generate

    return generate(model, context, options)


_COMPOSE = (
    Option("image", "image of all services (default: a variable, to be set when they are started)"),
    Option("setup", "setup file in the image (default: /opt/ros/jazzy/setup.bash)"),
    Option("arguments", "values of the system's arguments, as 'slam:=false robot:=r2'"),
)


@generator("rossystem", "compose", _COMPOSE)
def rossystem_compose(model: System, context: Context, options: Options) -> Files:
    """A compose file for each host, with a service for each node and process."""
    from deros.generators.system.compose.generate import generate

    return generate(model, context, options)


_RUNTIME = Option(
    "runtime",
    "'package': the package depends on the runtime, which is put beside it (default); "
    "'copy': it contains the runtime, for certification",
)

_SAFETY = (
    Option("package", "name of the generated package (default: the rules' name with _safety)"),
    Option("node", "name of the safety node (default: the package's name with _node)"),
    _MAINTAINER,
    _COPYRIGHT,
    _LICENCE,
    _RUNTIME,
)


@generator("deros", "python", _SAFETY)
def deros_python(model: Rules, context: Context, options: Options) -> Files:
    """The safety node: its node description, the pure monitor, the node and your actions."""
    from deros.generators.safety_package.python.generate import generate

    return generate(model, context, options)


@generator("deros", "cpp", _SAFETY)
def deros_cpp(model: Rules, context: Context, options: Options) -> Files:
    """The safety node as a composable rclcpp node around the monitor in C; names end in _cpp."""
    from deros.generators.safety_package.cpp.generate import generate

    return generate(model, context, options)


@generator("deros", "c")
def deros_c(model: Rules, context: Context, options: Options) -> Files:
    """The monitor as freestanding C99: a header and a source, for a PLC or a microcontroller."""
    from deros.generators.monitor.c.generate import generate

    assert not options
    return generate(model, context)
