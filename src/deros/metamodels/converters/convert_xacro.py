"""Parameters whose values xacro makes of files."""

from __future__ import annotations

from typing import Any

from deros.metamodels.converters.convert_launch import LaunchConverter
from deros.models.launch_files import LoadXacroFile, XacroFile
from deros.models.system import ParameterSetting


class XacroConverter(LaunchConverter):
    """Converts ``from xacro`` of a parameter."""

    load_xacro_file: LoadXacroFile
    """Reads the files when they are looked at."""

    def made_setting(self, found: Any) -> ParameterSetting:
        """Return a ``param`` whose value xacro makes."""
        written = found.xacro
        path, path_from = self.computed_name(written.path)
        span = self.span(written)
        # Whether anything is computed or not: in the text of the page it is as it is written.
        return ParameterSetting(
            self.written(found.name),
            f"from {' '.join(span.text.split())}",
            self.span(found),
            self.token_span(found.name),
            span,
            when=None if found.when is None else self.condition(found.when.condition),
            xacro=XacroFile(
                path,
                self.token_span(written.path),
                self.load_xacro_file,
                tuple(self.launch_argument(each, "xacro") for each in written.arguments),
                path_from,
            ),
        )
