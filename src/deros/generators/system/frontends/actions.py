"""The actions of a launch file in XML or YAML: what starts each program of a system."""

from __future__ import annotations

from collections.abc import Iterable, Iterator

from deros.generators.system.composition import Loads
from deros.generators.system.computed import Variables
from deros.generators.system.frontends.elements import Comment, Element, element, group
from deros.generators.system.frontends.grammar import template
from deros.generators.system.frontends.texts import Texts
from deros.generators.system.launched import LaunchView
from deros.generators.system.view import NodeView, ProcessView, ProgramView, SystemView


class Actions:
    """Makes the actions that start the programs of a system."""

    def __init__(self, view: SystemView, texts: Texts) -> None:
        """Make those of one system, whose texts are written in one way."""
        self._view = view
        self._texts = texts
        self._loads = Loads(view)

    def all(self) -> Iterator[Comment | Element]:
        """Yield the actions in the order of the system, each subsystem below its name."""
        for number, found in enumerate(self._view.groups):
            if found.path:
                said = f": {found.description}" if found.description else ""
                yield Comment(" / ".join(found.path) + said)
            elif number:
                yield Comment(self._view.name)
            for program in found.programs:
                yield from self._program(program)

    def _program(self, found: ProgramView) -> Iterator[Element]:
        if isinstance(found, LaunchView):
            yield self._included(found)
        elif isinstance(found, ProcessView):
            yield self._process(found)
        elif found.container is None:
            yield self._node(found)
        elif self._loads.elsewhere(found):
            yield element(
                "load_composable_node",
                *map(self._composable, self._loads.elsewhere(found)),
                target=self._texts.text(found.container),
            )

    def _node(self, node: NodeView) -> Element:
        texts = self._texts
        loaded = () if node.address is None else self._loads.into(node)
        made = element(
            "node_container" if loaded else "node",
            *self._settings(node),
            *self._environment(node.environment),
            *map(self._composable, loaded),
            pkg=template((node.package,)),
            exec_=template((node.executable,)),
            name=None if node.own_name else template((node.name,)),
            namespace=texts.text(node.namespace),
            args=texts.words(node.arguments),
            ros_args=texts.log_level(node) if node.log_level else None,
        )
        return self._started(made, node)

    def _process(self, process: ProcessView) -> Element:
        texts = self._texts
        made = element(
            "executable",
            *self._environment(process.environment),
            cmd=texts.words((process.program, *process.arguments)),
            name=template((process.name,)),
            cwd=None if process.folder is None else texts.text(process.folder),
        )
        return self._started(made, process)

    def _started(self, made: Element, program: NodeView | ProcessView) -> Element:
        """Return the action of a process with what nodes and others have in common."""
        is_again = program.respawn_delay is not None
        common = element(
            made.tag,
            *made.details,
            launch__prefix=None if program.prefix is None else self._texts.text(program.prefix),
            output="screen",
            respawn="true" if is_again else None,
            respawn_delay=program.respawn_delay,
            respawn_max_retries=program.respawn_max,
            on_exit="shutdown" if program.starting.stops_all is not None else None,
        )
        when = self._texts.condition(program.when)
        return Element(made.tag, (*made.attributes, *common.attributes, *when), made.details)

    def _composable(self, node: NodeView) -> Element:
        pointers = element("extra_arg", name="use_intra_process_comms", value="true")
        made = element(
            "composable_node",
            *self._settings(node),
            *([pointers] if node.intra_process else []),
            pkg=template((node.package,)),
            plugin=template((node.plugin,)),
            name=template((node.name,)),
            namespace=self._texts.text(node.namespace),
        )
        when = self._texts.condition(node.when)
        return Element(made.tag, (*made.attributes, *when), made.details)

    def _settings(self, node: NodeView) -> Iterator[Element]:
        texts = self._texts
        yield from (element("param", from_=texts.path(file)) for file in node.files)
        yield from (texts.parameter(name, value) for name, value in node.parameters)
        yield from (texts.described(name, made) for name, made in node.described)
        for name, target in node.remappings:
            yield element("remap", from_=texts.text(name), to=texts.text(target))

    def _environment(self, variables: Variables, tag: str = "env") -> Iterable[Element]:
        for name, value in variables:
            yield element(tag, name=template((name,)), value=self._texts.text(value))

    def _included(self, launch: LaunchView) -> Element:
        """Return the action that includes a launch file, with what counts for all of its nodes.

        It sees the arguments that it is given, and none of this file's own.
        """
        when = self._texts.condition(launch.when)
        if not hides_arguments(launch, self._view):
            return group(*self._inside(launch), condition=when)
        return group(*self._texts.hidden(lambda: self._inside(launch)), condition=when)

    def _inside(self, launch: LaunchView) -> Iterator[Element]:
        texts = self._texts
        space = texts.text(launch.namespace)
        if space:
            yield element("push_ros_namespace", namespace=space)
        yield from self._environment(launch.environment, "set_env")
        for file in launch.files:
            yield element("set_parameters_from_file", filename=texts.path(file))
        for parameter, setting in launch.parameters:
            value = texts.shown_value(setting)
            yield element("set_parameter", name=template((parameter,)), value=value)
        for name, target in launch.remappings:
            yield element("set_remap", from_=texts.text(name), to=texts.text(target))
        arguments = (
            element("arg", name=template((name,)), value=texts.launch_argument(value))
            for name, value in launch.launch_arguments
        )
        yield element("include", *arguments, file=texts.path(launch.file))


def hides_arguments(launch: LaunchView, view: SystemView) -> bool:
    """Return whether arguments of a system are to be hidden from a launch file."""
    given = {name for name, _ in launch.launch_arguments}
    return any(each.name not in given for each in view.arguments)
