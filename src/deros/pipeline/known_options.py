"""The options of a project file that a generator has."""

from __future__ import annotations

from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from collections.abc import Mapping

    from deros.generators.api.registry import Generator


def known_options(generator: Generator, given: Mapping[str, str]) -> Mapping[str, str]:
    """Return those of the options that a generator has."""
    known = {option.name for option in generator.options}
    return {name: text for name, text in given.items() if name in known}
