"""The interface of a generator: a pure function from a typed model and options to files.

A third-party generator is an entry point in the group ``textx_generators`` that refers to a
function decorated with :func:`deros.generators.api.registry.generator`. Both ``deros generate`` and
``textx generate`` find it.
"""

from __future__ import annotations

import enum
from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from pathlib import Path

    from deros.diagnostics import Diagnostic
    from deros.interfaces.store import InterfaceStore
    from deros.metamodels.load import LoadedFile, Repository
    from deros.models.rules import Rules
    from deros.rules.compiler.build import BuildResult
    from deros.rules.compiler.build_cache import BuildCache


class Owner(enum.Enum):
    """Who owns a file once it is written.

    Attributes:
        GENERATOR: deros: refreshed on every run, unless edited by hand.
        USER: the user: written once, never again.
        SHARED: both: replaced, and its text has in it what the user wrote.
    """

    GENERATOR = "generator"
    USER = "user"
    SHARED = "shared"


@dataclass(frozen=True, slots=True)
class File:
    """One file of a generator's output.

    Attributes:
        text: what is in it.
        owner: who owns it once it is written.
        executable: whether it can be run.
        original: of a copy, the file that it is a copy of. Where that lies in the output itself,
            no copy is written.
    """

    text: str
    owner: Owner = Owner.GENERATOR
    executable: bool = False
    original: Path | None = None


@dataclass(frozen=True, slots=True)
class Option:
    """An option of a generator, given as text on the command line (``--name value``).

    Attributes:
        name: lower case, with hyphens between words; the key in ``Options``.
        description: the help text.
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
        repository: the files loaded in this run; loads further ones.
        check: returns the findings of a file that a generator loads besides its model. By default
            these are the loader's; the pipeline passes in all checks of one file.
        builds: the monitors that the checks have built in this run; ``None`` without checks.
    """

    store: InterfaceStore
    repository: Repository
    check: Callable[[LoadedFile, InterfaceStore], Sequence[Diagnostic]] = _as_loaded
    builds: BuildCache | None = None

    def build(self, rules: Rules) -> BuildResult:
        """Return the monitor of ``rules``, reusing what the checks of this run have built."""
        if self.builds is not None:
            return self.builds.of(rules)
        from deros.rules.compiler.build import build

        return build(rules, self.store)


Files = Mapping[str, File]
"""The generated files by relative POSIX path."""

Options = Mapping[str, str]
"""The text given for each option, by its declared name; options not given are absent."""

GenerateFunction = Callable[[Any, Context, Options], Files]
"""The function of a generator. It neither prints nor writes to the disk.

It raises :class:`GenerationError` for what it cannot make from the model, and :class:`OptionError`
for an option that it cannot read.
"""


class OptionError(ValueError):
    """An option cannot be used; the text says why, as an error of the command line."""


class GenerationError(Exception):
    """The model is valid, but the target cannot be generated from it.

    Attributes:
        diagnostics: the reasons, with their locations in the model; at least one is an error.
    """

    def __init__(self, diagnostics: Iterable[Diagnostic]) -> None:
        """Store ``diagnostics`` in the given order."""
        self.diagnostics = tuple(diagnostics)
        super().__init__("; ".join(d.message for d in self.diagnostics))
