"""The parameter files that a system names."""

from __future__ import annotations

import re
from typing import Any

from deros import codes
from deros.metamodels.converters.convert_arguments import ArgumentConverter
from deros.models.parameter_files import Below, Load, ParameterFile, Plain

_PARAMETER = re.compile(r"[A-Za-z_]\w*(?:\.\w+)*", re.ASCII)


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
        plain = None if found.plain is None else self._plain(found.plain)
        given = None
        if found.given is not None:
            passed = found.given.arguments
            given = tuple(self.launch_argument(each, "a parameter file") for each in passed)
        return ParameterFile(
            path,
            self.span(found),
            span,
            self.load_parameter_file,
            path_from,
            when,
            is_assumed=plain is not None and not _PARAMETER.fullmatch(plain.parameter or "all"),
            below=below,
            plain=plain,
            given=given,
        )

    def _plain(self, found: Any) -> Plain:
        if found.parameter is None:
            return Plain("", self.span(found))
        name, span = self.written(found.parameter), self.token_span(found.parameter)
        if not _PARAMETER.fullmatch(name):
            message = f"'{name}' is not the name of a parameter"
            self.report(codes.SYNTAX_ERROR, message, span, "write one such as 'kinematics.arm'")
            self.lose(span)
        return Plain(name, self.span(found))

    def check_before_members(self, found: Any, has_members: bool) -> None:
        """Report a statement for all nodes of a system that stands behind one of them."""
        if has_members:
            message = "'parameters from' for all nodes stands before the first of them"
            hint = "move it there; for one node, write it right behind the node"
            self.report(codes.SYNTAX_ERROR, message, self.token_span(found.keyword), hint)
