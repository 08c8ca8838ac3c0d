"""Statements that start existing launch files."""

from __future__ import annotations

import re
from dataclasses import replace
from typing import Any

from deros import codes
from deros.metamodels.converters.convert_arguments import ArgumentConverter
from deros.metamodels.converters.convert_starting import OF_STARTERS, not_started
from deros.models.launch_files import LaunchFile, LoadLaunchFile
from deros.models.system import NodeInstance, Subsystem

_ENDING = re.compile(r"(?:\.launch|_launch)?\.\w+\Z")
_OF_STARTERS = {**OF_STARTERS, "GroupRemappings": "remappings"}
"""What says how a node is started, by the rules: that is up to the launch file."""


class LaunchConverter(ArgumentConverter):
    """Converts ``launch`` statements."""

    load_launch_file: LoadLaunchFile
    """Reads the files when they are looked at."""

    def launched(
        self, found: Any, modifiers: dict[str, Any], nodes: tuple[NodeInstance, ...]
    ) -> Subsystem:
        """Return a statement as the subsystem of the nodes that it describes.

        Args:
            found: the statement.
            modifiers: the fields that its modifiers set.
            nodes: that it describes.
        """
        path, path_from = self.computed_name(found.path)
        span = self.token_span(found.path)
        name = modifiers.pop("node_name", None) or _default_name(path)
        launch = LaunchFile(
            path,
            self.span(found),
            span,
            self.load_launch_file,
            tuple(map(self.launch_argument, found.arguments)),
            found.provides is not None,
            path_from,
        )
        for node in () if found.provides is None else found.provides.nodes:
            self._check_provided(node)
        return Subsystem(
            name,
            self.span(found),
            modifiers.pop("node_name_span", span),
            members=tuple(replace(not_started(each), remappings=()) for each in nodes),
            launch=launch,
            **modifiers,
        )

    def _check_provided(self, node: Any) -> None:
        for modifier in (*node.modifiers, *node.sections):
            word = _OF_STARTERS.get(type(modifier).__name__)
            if word is not None:
                self.report(
                    codes.SYNTAX_ERROR,
                    f"'{word}' says how a node is started, and the launch file starts this one",
                    self.span(modifier),
                    "remove it here; what it says stands in the launch file",
                )


def _default_name(path: str) -> str:
    """Return the name of a launch file that has no other: of ``nav.launch.py`` it is ``nav``.

    What is computed does not count, so that the name is the same for all values.
    """
    last = path.removesuffix("/").rpartition("/")[2]
    name = re.sub(r"\W+", "_", _ENDING.sub("", last), flags=re.ASCII).strip("_")
    return f"launch_{name}".strip("_") if not name or name[0].isdigit() else name
