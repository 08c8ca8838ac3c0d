"""The registry of generators by language and target, built in or from other distributions.

A generator is a function decorated with :func:`generator` and named by an entry point in the group
``textx_generators``, which is also the one that textX searches. ``textx generate`` calls the
decorated object with a textX model. Only the file name of that model is used: the typed model comes
from the loader of deros.
"""

from __future__ import annotations

import functools
import os
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from importlib.metadata import EntryPoint, entry_points
from pathlib import Path
from typing import Any

from deros import codes
from deros.diagnostics import Span, report
from deros.generators.api.protocol import (
    Context,
    Files,
    GenerateFunction,
    GenerationError,
    Option,
    OptionError,
)
from deros.metamodels.textx_registration import GeneratorDesc, GeneratorParam, TextXError

GROUP = "textx_generators"

_INTERFACES = GeneratorParam(
    "interfaces",
    f"folders with message definitions, separated by {os.pathsep!r}",
    mandatory=False,
)


class Generator(GeneratorDesc):  # type: ignore[misc]  # textX has no type hints
    """A target of one language; calling it with a typed model returns the files.

    Attributes:
        language: the textX name of the language, ``rosnode``, ``rossystem`` or ``deros``.
        target: the name of the target, unique within the language.
        description: the first paragraph of the function's docstring, on one line.
        options: the options on the command line, all of them optional.
        project_name: the distribution that provides it, once discovered.
        project_version: the version of that distribution.
    """

    language: str
    target: str
    description: str
    project_name: str | None
    project_version: str | None

    def __init__(
        self, language: str, target: str, function: GenerateFunction, options: Sequence[Option]
    ) -> None:
        """Wrap ``function`` in the description that textX asks for."""
        self.function = function
        self.options = tuple(options)
        custom = [GeneratorParam(_argument(o.name), o.description, False) for o in self.options]
        summary = " ".join((function.__doc__ or "").strip().partition("\n\n")[0].split())
        super().__init__(language, target, summary, self._run_for_textx, [*custom, _INTERFACES])

    def __call__(
        self, model: Any, context: Context, options: Mapping[str, str] | None = None
    ) -> Files:
        """Return the files for ``model``.

        Raises:
            GenerationError: if the target cannot be generated from the model.
            OptionError: if an option is not one of :attr:`options`.
        """
        given = dict(options or {})
        if unknown := sorted(given.keys() - {option.name for option in self.options}):
            raise OptionError(
                f"{self.language} -> {self.target} has no option {', '.join(map(repr, unknown))}"
            )
        files = self.function(model, context, given)
        _check_path_lengths(files, model)
        return files

    def __repr__(self) -> str:
        """Return a text with language and target."""
        return f"Generator({self.language!r}, {self.target!r})"

    def _run_for_textx(
        self,
        metamodel: Any,
        model: Any,
        output_path: str | None,
        overwrite: bool,
        debug: bool,  # noqa: ARG002
        **custom_args: Any,
    ) -> None:
        """Load, check, generate and write one file for ``textx generate``.

        ``run_generator`` of the metamodel does it, since generators must not import the pipeline.

        Raises:
            TextXError: if there are errors; its text holds all diagnostics. textX prints it and
                exits with 1.
        """
        filename = getattr(model, "_tx_filename", None)
        if not filename:
            raise TextXError(f"{self.language} -> {self.target} needs a model from a file")
        names = {_argument(option.name): option.name for option in self.options}
        interfaces = str(custom_args.pop("interfaces", ""))
        folders = tuple(Path(folder) for folder in interfaces.split(os.pathsep) if folder)
        options = {names.get(name, name): str(value) for name, value in custom_args.items()}
        metamodel.run_generator(self, filename, options, folders, output_path, overwrite)


def generator(
    language: str, target: str, options: Sequence[Option] = ()
) -> Callable[[GenerateFunction], Generator]:
    """Return a decorator that turns a function from typed model, context and options into files.

    The function's docstring becomes the description of the generator. Declare an entry point for
    the decorated object in the group ``textx_generators``::

        [project.entry-points.textx_generators]
        rossystem_dot = "my_package:dot"
    """

    def decorate(function: GenerateFunction) -> Generator:
        return Generator(language, target, function, options)

    return decorate


def _check_path_lengths(files: Files, model: Any) -> None:
    """Reject file names that are too long for file systems, before any file is written.

    Raises:
        GenerationError: if names in the model make a file name too long.
    """
    for path in files:
        for part in path.split("/"):
            if len(os.fsencode(part)) > _LONGEST_FILE_NAME:
                span = getattr(model, "name_span", None) or Span(model.source, 0, 0)
                message = f"the name of a file would have more than {_LONGEST_FILE_NAME} bytes"
                hint = f"shorten the name that '{part[:40]}…' is made from"
                raise GenerationError([report(codes.NAME_TOO_LONG, message, span, hint)])


_LONGEST_FILE_NAME = 255


# Discovery ----------------------------------------------------------------------------------------


@dataclass(frozen=True, slots=True)
class BrokenPlugin:
    """An entry point that could not be used, and the reason. Others are not affected."""

    entry_point: str
    distribution: str
    reason: str


@dataclass(frozen=True, slots=True)
class Registry:
    """All installed generators, sorted by language and target."""

    generators: tuple[Generator, ...]
    broken: tuple[BrokenPlugin, ...] = ()

    def find(self, language: str, target: str) -> Generator | None:
        """Return the generator of ``target`` for ``language``, or ``None``."""
        wanted = (language, target)
        return next((g for g in self.generators if (g.language, g.target) == wanted), None)

    def targets(self, language: str) -> tuple[str, ...]:
        """Return the targets of one language."""
        return tuple(g.target for g in self.generators if g.language == language)


@functools.cache
def discover() -> Registry:
    """Load the generators of all installed distributions.

    Generators of other textX languages in the same group are ignored. If two distributions declare
    the same target, the one of deros takes precedence, otherwise the first by name.
    """
    generators: dict[tuple[str, str], Generator] = {}
    broken: list[BrokenPlugin] = []
    for point in sorted(entry_points(group=GROUP), key=_own_first):
        distribution = point.dist.name if point.dist else "?"
        try:
            loaded = point.load()
        except Exception as error:  # a plug-in may raise anything
            reason = f"{type(error).__name__}: {error}"
            broken.append(BrokenPlugin(point.name, distribution, reason))
            continue
        if not isinstance(loaded, Generator):
            continue
        loaded.project_name = distribution
        loaded.project_version = point.dist.version if point.dist else None
        other = generators.setdefault((loaded.language, loaded.target), loaded)
        if other is not loaded:
            reason = f"{loaded.language} -> {loaded.target} is taken by {other.project_name}"
            broken.append(BrokenPlugin(point.name, distribution, reason))
    return Registry(tuple(generators[key] for key in sorted(generators)), tuple(broken))


def _own_first(point: EntryPoint) -> tuple[bool, str, str]:
    name = point.dist.name if point.dist else ""
    return name != "deros", name, point.name


def _argument(option: str) -> str:
    """Return the name of an option as textX passes it to a generator."""
    return option.replace("-", "_")
