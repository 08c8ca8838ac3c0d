"""Regular expressions read what people write; what deros itself made it keeps as data."""

from __future__ import annotations

import ast
from pathlib import Path

import pytest

SOURCE = Path(__file__).resolve().parents[1] / "src/deros"

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
        live/foxglove live/watched
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
    found = [
        path.relative_to(SOURCE).with_suffix("").as_posix()
        for path in SOURCE.rglob("*.py")
        if "re" in _imported(path)
    ]
    assert sorted(listed) == sorted(found)


def _imported(path: Path) -> set[str]:
    imports = (
        each
        for each in ast.walk(ast.parse(path.read_text(encoding="utf-8")))
        if isinstance(each, ast.Import | ast.ImportFrom)
    )
    return {
        name
        for each in imports
        for name in ([each.module] if isinstance(each, ast.ImportFrom) else _names(each))
        if name is not None
    }


def _names(found: ast.Import) -> list[str]:
    return [each.name for each in found.names]
