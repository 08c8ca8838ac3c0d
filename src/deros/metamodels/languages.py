"""The languages, each declared once for all rooms.

The functions of a language live in the room that they belong to and are named as entry points,
``module:attribute``. So a declaration names functions of higher rooms without importing them, and a
command loads only the languages that it meets.
"""

from __future__ import annotations

import os
from dataclasses import dataclass
from importlib import import_module
from pathlib import Path
from typing import Any

from deros.interfaces.files import asks_elsewhere


@dataclass(frozen=True, slots=True)
class Language:
    """One language of models.

    Attributes:
        name: its name in textX, which generators refer to.
        suffix: the ending of its files' names, ``.rnd``.
        kind: the word for ``deros new``.
        title: the plural noun for its files.
        description: one line for ``textx list-languages``.
        grammar: the textX grammar, a file of this folder or an absolute path.
        loader: entry point of the converter: it takes a :class:`~deros.metamodels.load.Loading` and
            returns the typed model.
        checks: entry point of the checks: they take a model and a
            :class:`~deros.validators.findings.context.CheckContext` and yield diagnostics.
        scaffold: entry point of the templates for ``deros new``, by file name, main file first.
    """

    name: str
    suffix: str
    kind: str
    title: str
    description: str
    grammar: str
    loader: str
    checks: str
    scaffold: str

    @property
    def pattern(self) -> str:
        """The glob that its files match, ``*.rnd``."""
        return f"*{self.suffix}"

    @property
    def grammar_file(self) -> Path:
        """The path of the grammar."""
        return Path(__file__).parent / self.grammar


ROSNODE = Language(
    name="rosnode",
    suffix=".rnd",
    kind="node",
    title="node descriptions",
    description="ROS 2 node descriptions: parameters and ports of a node",
    grammar="rosnode.tx",
    loader="deros.metamodels.converters.convert_node:load_node_type",
    checks="deros.validators.node.node:check",
    scaffold="deros.cli.scaffolds:NODE",
)
ROSSYSTEM = Language(
    name="rossystem",
    suffix=".system",
    kind="system",
    title="system descriptions",
    description="ROS 2 systems: nodes, topics and their wiring",
    grammar="rossystem.tx",
    loader="deros.metamodels.converters.convert_system:load_system",
    checks="deros.validators.system.system:check",
    scaffold="deros.cli.scaffolds:SYSTEM",
)
IMPORTED_BY_SYSTEMS = (ROSNODE, ROSSYSTEM)
"""The languages of the files that a system description may import."""

DEROS = Language(
    name="deros",
    suffix=".deros",
    kind="rules",
    title="safety rules",
    description="DeRoS safety rules: what must not happen, and the reaction if it does",
    grammar="deros.tx",
    loader="deros.metamodels.converters.rules.convert_rules:load_rules",
    checks="deros.validators.rules.rules:check",
    scaffold="deros.cli.scaffolds:RULES",
)

LANGUAGES: tuple[Language, ...] = (ROSNODE, ROSSYSTEM, DEROS)
"""Every language, in the order in which help texts list them."""


def language_of(path: str | os.PathLike[str]) -> Language | None:
    """Return the language of a file by the suffix of its name, or ``None``."""
    suffix = Path(path).suffix
    return next((each for each in LANGUAGES if each.suffix == suffix), None)


def language_named(name: str) -> Language | None:
    """Return the language with that name in textX, or ``None``."""
    return next((each for each in LANGUAGES if each.name == name), None)


def suffixes() -> tuple[str, ...]:
    """Return the suffixes of all languages."""
    return tuple(each.suffix for each in LANGUAGES)


def listed() -> str:
    """Return the kinds of models for help texts: ``node descriptions (*.rnd), …``."""
    *most, last = (f"{each.title} ({each.pattern})" for each in LANGUAGES)
    return f"{', '.join(most)} and {last}"


def entry_point(reference: str) -> Any:
    """Import what an entry point names, ``module:attribute``."""
    module, _, attribute = reference.partition(":")
    if module.partition(".")[0] != "deros":
        asks_elsewhere(module)
    return getattr(import_module(module), attribute)
