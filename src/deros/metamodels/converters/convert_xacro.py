"""Parameters whose values xacro makes of files."""

from __future__ import annotations

from collections.abc import Iterable
from typing import Any

from deros.metamodels.converters.convert_launch import LaunchConverter
from deros.models.launch_files import LoadXacroFile, MadeFile, XacroFile
from deros.models.system import ParameterSetting


class XacroConverter(LaunchConverter):
    """Converts ``from xacro`` of a parameter."""

    load_xacro_file: LoadXacroFile
    """Reads the files when they are looked at."""

    def made_setting(self, found: Any) -> ParameterSetting:
        """Return a ``param`` whose value xacro makes."""
        written = found.xacro
        span = self.span(written)
        # Whether anything is computed or not: in the text of the page it is as it is written.
        return ParameterSetting(
            self.written(found.name),
            f"from {' '.join(span.text.split())}",
            self.span(found),
            self.token_span(found.name),
            span,
            when=None if found.when is None else self.condition(found.when.condition),
            xacro=self._xacro(written),
        )

    def _xacro(self, written: Any) -> XacroFile:
        path, path_from = self.computed_name(written.path)
        return XacroFile(
            path,
            self.token_span(written.path),
            self.load_xacro_file,
            tuple(self.launch_argument(each, "xacro") for each in written.arguments),
            path_from,
        )

    def note_made_files(self, parts: Iterable[Any]) -> None:
        """Find the files that are made, so that expressions may use their paths.

        Args:
            parts: of the whole system, as parsed.
        """
        for part in parts:
            if type(part).__name__ == "MadeFile":
                when = None if part.when is None else self.condition(part.when.condition)
                name, span = str(part.name), self.span(part)
                found = MadeFile(
                    name, self._xacro(part.made), span, self.token_span(part.name), when
                )
                self.made_files.setdefault(name, found)
                self.made_files_at[span.start] = found
            elif type(part).__name__ == "Subsystem":
                self.note_made_files(part.parts)

    def made_file(self, part: Any) -> MadeFile:
        """Return the file of a statement, which has been noted."""
        return self.made_files_at[self.span(part).start]
