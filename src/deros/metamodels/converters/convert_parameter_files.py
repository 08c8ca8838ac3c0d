"""The parameter files that a system names."""

from __future__ import annotations

from typing import Any

from deros import codes
from deros.metamodels.converters.convert_arguments import ArgumentConverter
from deros.models.parameter_files import Below, Load, ParameterFile


class ParameterFileConverter(ArgumentConverter):
    """Converts ``parameters from`` statements."""

    load_parameter_file: Load
    """Reads the files when they are looked at."""

    def parameter_file(self, found: Any) -> ParameterFile:
        """Return the statement."""
        path, path_from = self.computed_name(found.path)
        when = None if found.when is None else self.condition(found.when.condition)
        span = self.token_span(found.path)
        below: Below | None = None
        if found.below is not None:
            namespace, namespace_from = self.computed_name(found.below)
            below = Below(namespace, self.token_span(found.below), namespace_from)
        return ParameterFile(
            path, self.span(found), span, self.load_parameter_file, path_from, when, below=below
        )

    def check_before_members(self, found: Any, has_members: bool) -> None:
        """Report a statement for all nodes of a system that stands behind one of them."""
        if has_members:
            message = "'parameters from' for all nodes stands before the first of them"
            hint = "move it there; for one node, write it right behind the node"
            self.report(codes.SYNTAX_ERROR, message, self.token_span(found.keyword), hint)
