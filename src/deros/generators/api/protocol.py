"""What a generator is: a pure function from a typed model and options to files.

A generator from outside is one entry point in the group ``textx_generators`` whose object is made
by :func:`deros.generators.api.registry.generator`; it is then known to ``textx generate`` and
``deros generate`` alike.
"""

from __future__ import annotations

import enum
from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from deros.diagnostics import Diagnostic
    from deros.interfaces.store import InterfaceStore
    from deros.metamodels.load import LoadedFile, Repository
    from deros.metamodels.rules import Rules
    from deros.monitor.build import BuildResult
    from deros.monitor.build_cache import BuildCache


class Owner(enum.Enum):
    """Whose file it is once written."""

    GENERATOR = "generator"  # refreshed on every run, unless edited by hand
    USER = "user"  # written once, never again


@dataclass(frozen=True, slots=True)
class File:
    """One file of a generator's output."""

    text: str
    owner: Owner = Owner.GENERATOR
    executable: bool = False


@dataclass(frozen=True, slots=True)
class Option:
    """An option of a generator, given as text on the command line (``--name value``).

    The name is lower case and may hold hyphens; generators look it up exactly as declared.
    """

    name: str
    description: str


def _as_loaded(loaded: LoadedFile, store: InterfaceStore) -> Sequence[Diagnostic]:  # noqa: ARG001
    return loaded.diagnostics


@dataclass(frozen=True, slots=True)
class Context:
    """What a generator may use besides its model.

    Attributes:
        store: the message, service and action definitions.
        repository: the files loaded in this run, and the way to load more.
        check: returns the findings of a file that a generator loads besides its model. By default
            these are the loader's; the pipeline passes in all checks of one file.
        builds: the rules that the checks have built in this run, if there were checks.
    """

    store: InterfaceStore
    repository: Repository
    check: Callable[[LoadedFile, InterfaceStore], Sequence[Diagnostic]] = _as_loaded
    builds: BuildCache | None = None

    def build(self, rules: Rules) -> BuildResult:
        """Return rules built for a monitor, from this run's checks where they have built them."""
        if self.builds is not None:
            return self.builds.of(rules)
        from deros.monitor.build import build

        return build(rules, self.store)


Files = Mapping[str, File]
"""Relative POSIX paths and what they hold."""

Options = Mapping[str, str]
"""Option names as declared, and the texts given for them; options not given are absent."""

GenerateFunction = Callable[[Any, Context, Options], Files]
"""A generator's own function. It neither prints nor touches the disk."""


class GenerationError(Exception):
    """The model is sound, but this target cannot be made from it.

    Attributes:
        diagnostics: why, each with its place in the model; at least one is an error.
    """

    def __init__(self, diagnostics: Iterable[Diagnostic]) -> None:
        """Carry ``diagnostics``, in the order found."""
        self.diagnostics = tuple(diagnostics)
        super().__init__("; ".join(d.message for d in self.diagnostics))
