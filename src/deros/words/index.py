"""The index of one file, whatever its language."""

from __future__ import annotations

from deros.interfaces.store import InterfaceStore
from deros.models.node import NodeType
from deros.models.rules import Rules
from deros.models.system import System
from deros.rules.compiler.build_cache import BuildCache
from deros.words.nodes import words_of_node
from deros.words.rules import words_of_rules
from deros.words.systems import words_of_system
from deros.words.words import Index


def index_of(
    model: NodeType | System | Rules | None, builds: BuildCache, store: InterfaceStore
) -> Index:
    """Return the words of a model; of a file that could not be read there are none."""
    match model:
        case NodeType():
            return Index(words_of_node(model))
        case System():
            return Index(words_of_system(model, builds.flat(model)))
        case Rules():
            return Index(words_of_rules(model, builds.of(model), store))
        case _:
            return Index(())
