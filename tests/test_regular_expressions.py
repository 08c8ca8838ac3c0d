"""Regular expressions read what people write; what deros itself made it keeps as data."""

from __future__ import annotations

import json
import subprocess
import sys
from typing import Any

import pytest
from regexploit.ast.sre import SreOpParser
from regexploit.redos import find

from tests.support.imports import imports

READ = {
    "models": """
        diff/meanings
        metamodels/grammar metamodels/matching metamodels/reading metamodels/repaired_text
        metamodels/tokens
        metamodels/converters/convert metamodels/converters/convert_arguments
        metamodels/converters/convert_launch metamodels/converters/convert_parameter_files
        metamodels/converters/rules/convert_terms
        metamodels/recovery/edits
        metamodels/recovery/durations_inside metamodels/recovery/habits
        metamodels/recovery/recogniser metamodels/recovery/recovery metamodels/recovery/repairs
        metamodels/recovery/resumption metamodels/recovery/syntax
        lsp/completion/complete lsp/completion/units
        generators/node/package generators/safety_node/view generators/text/provenance
        rules/compiler/scope/mentions rules/compiler/scope/scope rules/functions/reads
        validators/findings/allowances
        validators/findings/consequences validators/rules/rules_readings
        validators/safety/safety_rules diagnostics
    """,
    "names, values and units of models": """
        generators/monitor/c/code/names generators/monitor/c/code/view
        generators/monitor/computed generators/system/frontends/grammar
        generators/system/frontends/xml generators/system/frontends/yaml
        generators/monitor/python/names validators/node/plugins
        exporters/nodl live/verify/compare
        generators/node/description generators/system/described generators/system/files
        generators/system/launch/substitutions
        generators/system/systemd/units generators/system/view generators/text/identifiers
        generators/text/yaml importers/node_types interfaces/fields
        interfaces/units models/node models/parameter_files
        names/names names/topic_likeness systems/arguments/symbolic systems/parameters/overrides
        systems/safety_nodes validators/system/running/programs
        validators/system/running/hosts
        validators/node/constraints validators/node/files validators/node/interfaces
        validators/node/node
    """,
    "other files, and the command line": """
        cli/commands/explain generators/output/banner generators/text/notice
        generators/system/script/standalone/arguments
        generators/system/script/standalone/command_line
        generators/system/script/standalone/containers/values
        generators/system/script/standalone/hosts/connection
        generators/system/script/standalone/made/below
        generators/system/script/standalone/made/substituting
        generators/system/script/standalone/made/under
        generators/system/script/standalone/programs
        generators/system/script/standalone/watch/table
        generators/user_files/manifest generators/user_files/python importers/kept/files
        importers/formats/names importers/formats/nodl importers/formats/parameter_library
        importers/formats/parameters importers/formats/rostooling_nodes
        importers/formats/rostooling_systems
        importers/recognized
        importers/recordings/definitions importers/recordings/reading
        importers/launch/actions importers/launch/described importers/launch/programs
        importers/launch/reading importers/launch/scopes
        importers/launch/values/argument_types importers/launch/values/expressions
        importers/launch/values/python_expressions importers/launch/values/substitutions
        importers/launch/values/writing
        interfaces/definitions
        live/foxglove live/states live/watched
        interfaces/sources metamodels/launch_files/contents metamodels/launch_files/xacro
        metamodels/parameter_files/reading
        metamodels/parameter_files/scalars metamodels/parameter_files/substituting
        pipeline/depfile pipeline/project pipeline/scaffold
        simulation/timelines/cells simulation/timelines/document simulation/timelines/sections
        simulation/trace simulation/trace_values validators/findings/hints
    """,
    "generated code, for its layout alone": """
        generators/monitor/c/line_wrapping generators/safety_package/cpp/generate
    """,
    "generated code, for what is in it": """
        generators/monitor/c/helpers generators/monitor/c/render generators/safety_node/cpp/whys
        generators/text/cpp
    """,
}
"""The modules with regular expressions, by what these read.

Those of the last kind find which helpers, headers and members a text uses after it was printed. A
printer that tells what it uses has no place here.
"""


@pytest.mark.essential
def test_every_regular_expression_has_its_reason() -> None:
    """No module reads messages; whoever adds an expression says here what it reads."""
    listed = [name for names in READ.values() for name in names.split()]
    found = imports().find_modules_that_directly_import("re")
    assert sorted(listed) == sorted(
        module.removeprefix("deros.").replace(".", "/") for module in found
    )


def test_no_regular_expression_takes_cubic_time() -> None:
    """None can be made to hang, or to take seconds for a line of a few thousand characters."""
    command = [sys.executable, "-m", "tests.support.compiled_patterns"]
    found = json.loads(subprocess.run(command, check=True, capture_output=True, text=True).stdout)
    assert len(found) > 400
    slow = {
        f"{path}:{line}: {pattern}"
        for pattern, flags, path, line in found
        if takes_cubic_time(pattern, flags)
    }
    assert not slow


@pytest.mark.parametrize(
    ("pattern", "is_slow"),
    [
        (r"(?:\s|//[^\n]*)*x", True),
        (r"(?:\s|//[^\n]*\n)*x", False),
        (r"a(?=(?:\s|//[^\n]*)*x)", True),
        (r"a(?!(?:\s|//[^\n]*)*x)", True),
        (r"a(?!(?:\s|//[^\n]*\n)*x)", False),
        (r"=\s*([^:\n]*?)\s*:", True),
        (r"=\s*([^:\s](?:[^:\n]*[^:\s])?)\s*:", False),
    ],
)
def test_slow_regular_expressions_are_recognised(pattern: str, is_slow: bool) -> None:
    """What had been written so, and what it was mended by."""
    assert takes_cubic_time(pattern, 0) == is_slow


@pytest.mark.parametrize("pattern", [r"(?:\s|//[^\n]*)*+x", r"(?>\s*)x"])
def test_regular_expressions_of_newer_pythons_are_recognised(pattern: str) -> None:
    """They would stop a module from being imported."""
    with pytest.raises(ValueError, match=r"3\.10"):
        takes_cubic_time(pattern, 0)


class _Parser(SreOpParser):  # type: ignore[misc]
    """Keeps what is only looked at, and refuses what the oldest Python of deros would refuse."""

    def __init__(self) -> None:
        super().__init__()
        self.looked_at: list[Any] = []

    def from_ASSERT(self, part: Any) -> None:  # noqa: N802
        self.looked_at.append(self.sequence_or_singleton(part[1]))

    def from_ASSERT_NOT(self, part: Any) -> Any:  # noqa: N802
        self.from_ASSERT(part)
        return super().from_ASSERT_NOT(part)

    def from_POSSESSIVE_REPEAT(self, part: object) -> None:  # noqa: N802
        raise ValueError(f"Python 3.10 does not know {part}")

    from_ATOMIC_GROUP = from_POSSESSIVE_REPEAT  # noqa: N815


def takes_cubic_time(pattern: str, flags: int) -> bool:
    """Return whether some text of n characters takes n^3 steps or more to be refused."""
    parser = _Parser()
    whole = parser.parse_sre(pattern, flags)
    return any(next(iter(find(each)), None) for each in (whole, *parser.looked_at))
