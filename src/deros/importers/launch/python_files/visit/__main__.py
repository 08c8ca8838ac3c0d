"""``python __main__.py RESULT FILE VALUES``: run a launch file, and write what it has made."""

from __future__ import annotations

import json
import sys
import traceback
from pathlib import Path
from typing import Any

# Python puts the folder of this file before all others: names in it are not for the launch file.
sys.path = [each for each in sys.path if Path(each or ".").resolve() != Path(__file__).parent]

from deros.importers.launch.python_files.visit.constructors import record  # noqa: E402
from deros.importers.launch.python_files.visit.places import note  # noqa: E402
from deros.importers.launch.python_files.visit.visitor import Visitor, failure  # noqa: E402


def main(result: str, file: str, values: str) -> None:
    """Write a JSON object: what the launch file has made, or why nothing.

    Args:
        result: the path to write to.
        file: the launch file, by its full path.
        values: of arguments, as a JSON object of texts.
    """
    try:
        note(file)
        recorded = _launch(file)
    except ImportError as error:
        found: dict[str, Any] = {"absent": str(error)}
    else:
        try:
            found = _visited(recorded, file, json.loads(values))
        except (Exception, SystemExit) as error:
            found = {"failed": failure(error), "line": _line(error, file)}
    Path(result).write_text(json.dumps(found), encoding="utf-8")


def _line(error: BaseException, file: str) -> int:
    """Return the line of a file in which it fails; 0 if it does so elsewhere."""
    if isinstance(error, SyntaxError) and error.filename == file:
        return error.lineno or 0
    steps = traceback.extract_tb(error.__traceback__)
    return next((e.lineno or 0 for e in reversed(steps) if e.filename == file), 0)


def _launch(file: str) -> Any:
    """Return launch, which records what the file makes."""
    import launch
    import launch.actions
    import launch.conditions
    import launch.launch_description_sources
    import launch.substitutions
    import launch_ros.actions
    import launch_ros.descriptions
    import launch_ros.parameter_descriptions
    import launch_ros.substitutions

    described = launch_ros.parameter_descriptions
    record(
        (
            launch.Action,
            launch.Condition,
            launch.LaunchDescriptionSource,
            launch.Substitution,
            launch_ros.descriptions.ComposableNode,
            described.Parameter,
            described.ParameterFile,
            described.ParameterValue,
        ),
        file,
    )
    return launch


def _visited(launch: Any, file: str, values: dict[str, str]) -> dict[str, Any]:
    context = launch.LaunchContext(noninteractive=True)
    context.launch_configurations.update(values)
    folder = str(Path(file).parent)
    context.extend_locals(
        {"current_launch_file_path": file, "current_launch_file_directory": folder}
    )
    source = launch.launch_description_sources.PythonLaunchDescriptionSource(file)
    description = source.get_launch_description(context)
    visitor = Visitor(context, values)
    actions = visitor.elements(description.entities)
    visitor.close()
    return {"actions": actions, "unsaid": visitor.unsaid}


main(*sys.argv[1:])
