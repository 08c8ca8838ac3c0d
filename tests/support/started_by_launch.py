"""All that the real ``launch`` and ``launch_ros`` start of a launch file, without starting it.

Run as a program, in an environment in which these can be imported: it prints programs and loaded
nodes as JSON. A file that launch refuses ends it with the reason, and exit code 1.
"""

from __future__ import annotations

import asyncio
import json
import os
import sys
from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import Any

import yaml

from tests.support.resolved_launch import _Loader


def started(path: str, arguments: Mapping[str, str], namespace: str) -> Iterator[dict[str, Any]]:
    """Yield what a launch file starts that is included below a namespace."""
    import launch
    from launch.launch_description_sources import AnyLaunchDescriptionSource
    from launch_ros.actions import PushRosNamespace

    context = launch.LaunchContext(argv=[])
    loop = asyncio.new_event_loop()
    context._set_asyncio_loop(loop)
    included = launch.actions.GroupAction(
        [
            *([PushRosNamespace(namespace)] if namespace else []),
            launch.actions.IncludeLaunchDescription(
                AnyLaunchDescriptionSource(path), launch_arguments=list(arguments.items())
            ),
        ]
    )
    try:
        yield from _visited(included, context)
    finally:
        for task in asyncio.all_tasks(loop):  # each would start a process
            task.cancel()
        loop.run_until_complete(asyncio.sleep(0))
        loop.close()


def _visited(entity: Any, context: Any) -> Iterator[dict[str, Any]]:
    from launch.actions import ExecuteLocal
    from launch_ros.actions import LoadComposableNodes

    if isinstance(entity, LoadComposableNodes):
        if entity.condition is None or entity.condition.evaluate(context):
            yield from _loaded(entity, context)
        return
    further = entity.visit(context) or ()  # of a process: what follows, it runs in no loop
    if isinstance(entity, ExecuteLocal) and entity.process_details is not None:
        yield _process(entity)
    for each in further:
        yield from _visited(each, context)


def _process(action: Any) -> dict[str, Any]:
    found = action.process_details
    words = [str(word) for word in found["cmd"]]
    parameters: dict[str, Any] = {}
    others, rest = [], iter(words)
    for word in rest:
        if word != "--params-file":
            others.append(word)
            continue
        _merge(parameters, yaml.load(Path(next(rest)).read_text(encoding="utf-8"), _Loader))
    variables = found["env"] or {}
    return {
        "words": others,
        "parameters": parameters,
        "folder": found["cwd"],
        "variables": {
            name: value for name, value in variables.items() if os.environ.get(name) != value
        },
        "respawn": [
            str(getattr(action, f"_ExecuteLocal__{name}"))
            for name in ("respawn_delay", "respawn_max_retries")
        ],
        "stops all": bool(action._ExecuteLocal__on_exit),
    }


def _merge(into: dict[str, Any], found: Mapping[str, Any]) -> None:
    for key, value in found.items():
        if isinstance(value, Mapping):
            _merge(into.setdefault(key, {}), value)
        else:
            into[key] = value


def _loaded(action: Any, context: Any) -> Iterator[dict[str, Any]]:
    from launch.utilities import normalize_to_list_of_substitutions, perform_substitutions
    from launch_ros.actions.load_composable_nodes import get_composable_node_load_request

    target = action._LoadComposableNodes__target_container
    if hasattr(target, "node_name"):
        container = target.node_name
    else:
        container = perform_substitutions(context, normalize_to_list_of_substitutions(target))
    for each in action._LoadComposableNodes__composable_node_descriptions:
        request = get_composable_node_load_request(each, context)
        if request is not None:
            yield {
                "container": container,
                "class": [request.package_name, request.plugin_name],
                "name": [request.node_namespace, request.node_name],
                "remappings": list(request.remap_rules),
                "parameters": {e.name: _fields(e.value) for e in request.parameters},
                "extra": {e.name: _fields(e.value) for e in request.extra_arguments},
            }


def _fields(value: Any) -> dict[str, Any]:
    kinds = ("bool", "integer", "double", "string")
    scalars = {kind: getattr(value, f"{kind}_value") for kind in kinds}
    arrays = {f"{kind}[]": list(getattr(value, f"{kind}_array_value")) for kind in kinds}
    return {"type": value.type, **scalars, **arrays}


def main() -> None:
    """Print what is started by the launch file that the second word names, as JSON.

    The first is the namespace that it is included in, or nothing.
    """
    namespace, path, *words = sys.argv[1:]
    arguments = dict(word.split(":=", 1) for word in words)
    try:
        found = [*started(path, arguments, namespace)]
        print(json.dumps(found, default=repr, sort_keys=True), flush=True)
    except Exception as fault:
        print(f"{type(fault).__name__}: {fault}", file=sys.stderr, flush=True)
        os._exit(1)
    os._exit(0)  # the node that launch_ros makes for managed nodes spins in a thread for ever


if __name__ == "__main__":
    main()
