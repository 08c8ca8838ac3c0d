"""The actions of launch as the elements that they would be in XML."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Mapping
from functools import partial
from typing import Any, NamedTuple

from deros.importers.launch.python_files.visit.constructors import given, kind, line
from deros.importers.launch.python_files.visit.elements import Made, element
from deros.importers.launch.python_files.visit.parameters import (
    in_yaml,
    parameter,
    parameters,
    remappings,
    variables,
)
from deros.importers.launch.python_files.visit.texts import (
    Call,
    is_text,
    pieces,
    plain_name,
)


class Site(NamedTuple):
    """Where an action stands.

    Attributes:
        inner: makes elements of the actions in it.
        computed: returns the parameters that a file which is made on the way has for a node, by
            the node and the file; ``None`` of other files.
    """

    inner: Callable[[Iterable[Any]], list[Made]]
    computed: Callable[[Any, Any], Mapping[str, Any] | None]


_NAMES: Mapping[str, tuple[str, Mapping[str, str]]] = {
    "AppendEnvironmentVariable": (
        "append_env",
        {"name": "name", "value": "value", "prepend": "prepend", "separator": "separator"},
    ),
    "PushROSNamespace": ("push_ros_namespace", {"namespace": "namespace"}),
    "PushRosNamespace": ("push_ros_namespace", {"namespace": "namespace"}),
    "ResetEnvironment": ("reset_env", {}),
    "SetEnvironmentVariable": ("set_env", {"name": "name", "value": "value"}),
    "SetLaunchConfiguration": ("let", {"name": "name", "value": "value"}),
    "SetParametersFromFile": ("set_parameters_from_file", {"filename": "filename"}),
    "SetRemap": ("set_remap", {"src": "from", "dst": "to"}),
    "SetROSLogDir": ("set_ros_log_dir", {"new_log_dir": "new_log_dir"}),
    "SetUseSimTime": ("set_use_sim_time", {"value": "value"}),
    "UnsetEnvironmentVariable": ("unset_env", {"name": "name"}),
    "UnsetLaunchConfiguration": ("unset", {"name": "name"}),
}
"""Actions that have attributes alone: their names in XML, and those of what they are given."""

_PROCESS = {
    "prefix": "launch-prefix",
    "name": "name",
    "cwd": "cwd",
    "output": "output",
    "respawn": "respawn",
    "respawn_delay": "respawn_delay",
    "respawn_max_retries": "respawn_max_retries",
    "shell": "shell",
    "emulate_tty": "emulate_tty",
    "sigterm_timeout": "sigterm_timeout",
    "sigkill_timeout": "sigkill_timeout",
}
"""What all programs may be given, and the attributes that it is."""

_SAID_OTHERWISE = frozenset(
    {
        *("condition", "env", "additional_env", "on_exit", "cmd", "package", "executable"),
        *("namespace", "parameters", "remappings", "arguments", "ros_arguments", "exec_name"),
        *("composable_node_descriptions", "log_cmd", "cached_output", "output_format"),
        *("autostart",),
    }
)


def made(action: Any, site: Site) -> Made | None:
    """Return the element of an action; ``None`` if there is none for it."""
    what = kind(action)
    if what in _NAMES:
        tag, names = _NAMES[what]
        said = given(action)
        attributes = {names[each]: said[each] for each in names if each in said}
        return element(tag, line(action), attributes | conditions(action))
    maker = _MAKERS.get(what)
    return None if maker is None else maker(action, site)


def conditions(action: Any) -> dict[str, Any]:
    """Return when an action is executed, as attributes."""
    condition = given(action).get("condition")
    if condition is None:
        return {}
    what, said = kind(condition), given(condition)
    if what in ("IfCondition", "UnlessCondition"):
        return {"if" if what == "IfCondition" else "unless": said["predicate_expression"]}
    word = {
        "LaunchConfigurationEquals": "equals",
        "LaunchConfigurationNotEquals": "not-equals",
    }.get(what)
    if word is None or said.get("expected_value") is None:
        return {"if": Call(plain_name(what))}
    value = Call("var", (pieces(said["launch_configuration_name"]),))
    return {"if": Call(word, ((value,), pieces(said["expected_value"])))}


# Programs ---------------------------------------------------------------------------------------


def _node(action: Any, site: Site) -> Made:
    return _program(action, "node", site)


def _managed(action: Any, site: Site) -> Made:
    return _program(action, "lifecycle_node", site)


def _container(action: Any, site: Site) -> Made:
    found = _program(action, "node_container", site)
    inside = given(action).get("composable_node_descriptions") or ()
    found["children"] += [_component(each, site) for each in inside]
    return found


def _program(action: Any, tag: str, site: Site) -> Made:
    said = given(action)
    attributes = {
        "pkg": said.get("package"),
        "exec": said.get("executable"),
        "namespace": said.get("namespace"),
        "autostart": said.get("autostart"),
        **_process(action),
    }
    commands = {"args": said.get("arguments") or (), "ros_args": said.get("ros_arguments") or ()}
    children = [*_variables(action), *_settings(action, site)]
    return element(tag, line(action), attributes, children, commands=commands)


def _loaded(action: Any, site: Site) -> Made:
    said = given(action)
    target = said["target_container"]
    if kind(target) == "ComposableNodeContainer":
        of = given(target)
        space = of.get("namespace") or "/"
        target = (space, "" if space == "/" else "/", of["name"])
    children = [_component(each, site) for each in said["composable_node_descriptions"]]
    attributes = {"target": target, **conditions(action)}
    return element("load_composable_node", line(action), attributes, children)


def _component(described: Any, site: Site) -> Made:
    said, place = given(described), line(described)
    attributes = {
        "pkg": said["package"],
        "plugin": said["plugin"],
        "name": said.get("name"),
        "namespace": said.get("namespace"),
        **conditions(described),
    }
    children = [*_settings(described, site)]
    for each in said.get("extra_arguments") or ():
        if isinstance(each, Mapping):
            children += (parameter(name, each[name], place, "extra_arg") for name in each)
    return element("composable_node", place, attributes, children)


def _settings(described: Any, site: Site) -> Iterator[Made]:
    said, place = given(described), line(described)
    computed = partial(site.computed, described)
    yield from parameters(said.get("parameters") or (), place, computed)
    yield from remappings(said.get("remappings") or (), place)


def _executable(action: Any, _: Site) -> Made:
    said = given(action)
    attributes, commands = _process(action), {"cmd": said["cmd"]}
    if said.get("shell") in (True, "true", "True"):
        # The shell gets all words in one text, whatever is in them.
        spaced = [piece for each in said["cmd"] for piece in (" ", each)][1:]
        attributes, commands = {**attributes, "cmd": spaced}, {}
    return element("executable", line(action), attributes, _variables(action), commands=commands)


def _process(action: Any) -> dict[str, Any]:
    """Return what all programs may be given, as attributes."""
    said = given(action)
    found = {_PROCESS[name]: said[name] for name in _PROCESS if name in said}
    for name in said.keys() - _PROCESS.keys() - _SAID_OTHERWISE:
        found[name] = said[name] if is_text(said[name]) else "..."
    end = said.get("on_exit")
    if end is not None:
        ends = end if isinstance(end, (list, tuple)) else [end]
        is_shutdown = [kind(each) for each in ends] == ["Shutdown"]
        found["on_exit"] = "shutdown" if is_shutdown else "other actions"
    return found | conditions(action)


def _variables(action: Any) -> Iterator[Made]:
    said = given(action)
    yield from variables(said.get("additional_env") or {}, line(action))
    if said.get("env") is not None:
        yield element("env", line(action), {"replaces": "the whole environment"})


# What holds actions -----------------------------------------------------------------------------


def _argument(action: Any, _: Site) -> Made:
    said = given(action)
    names = {"name": "name", "default_value": "default", "description": "description"}
    attributes = {names[each]: said.get(each) for each in names}
    choices = [element("choice", line(action), {"value": e}) for e in said.get("choices") or ()]
    return element("arg", line(action), attributes | conditions(action), choices)


def _group(action: Any, site: Site) -> Made:
    said = given(action)
    attributes = {each: said.get(each) for each in ("scoped", "forwarding")}
    children = [*_kept(action), *site.inner(said["actions"])]
    return element("group", line(action), attributes | conditions(action), children)


def _reset(action: Any, _: Site) -> Made:
    return element("reset", line(action), conditions(action), _kept(action))


def _kept(action: Any) -> Iterator[Made]:
    for name, value in (given(action).get("launch_configurations") or {}).items():
        yield element("keep", line(action), {"name": name, "value": value})


def _timer(action: Any, site: Site) -> Made:
    said = given(action)
    attributes = {"period": said["period"], **conditions(action)}
    if said.get("cancel_on_shutdown") is not None:
        attributes["cancel_on_shutdown"] = said["cancel_on_shutdown"]
    return element("timer", line(action), attributes, site.inner(said["actions"]))


def _include(action: Any, _: Site) -> Made | None:
    source = given(action)["launch_description_source"]
    path = source
    if not is_text(source):
        path = given(source).get("launch_file_path")
        if path is None:
            return None
    attributes = {"file": path, **conditions(action)}
    values = [
        element("arg", line(action), {"name": name, "value": value})
        for name, value in action.launch_arguments
    ]
    return element("include", line(action), attributes, values)


def _parameter(action: Any, _: Site) -> Made:
    said = given(action)
    attributes = {"name": said["name"], "value": in_yaml(said["value"]), **conditions(action)}
    return element("set_parameter", line(action), attributes)


_MAKERS: Mapping[str, Callable[[Any, Site], Made | None]] = {
    "ComposableNodeContainer": _container,
    "DeclareLaunchArgument": _argument,
    "ExecuteProcess": _executable,
    "GroupAction": _group,
    "IncludeLaunchDescription": _include,
    "LifecycleNode": _managed,
    "LoadComposableNodes": _loaded,
    "Node": _node,
    "ROSTimer": _timer,
    "ResetLaunchConfigurations": _reset,
    "RosTimer": _timer,
    "SetParameter": _parameter,
    "TimerAction": _timer,
}
