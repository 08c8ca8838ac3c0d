"""Generators by language and target, built in or from other distributions, found by entry point.

A generator is a function decorated with :func:`generator` and named by an entry point in the group
``textx_generators``. The decorated object is what textX looks for there, too: ``textx generate``
calls it with a textX model, of which only the file's name is used; the typed model comes from our
loader.
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
from deros.generators.api.protocol import Context, Files, GenerateFunction, GenerationError, Option
from deros.metamodels.textx_registration import GeneratorDesc, GeneratorParam, TextXError

GROUP = "textx_generators"

_INTERFACES = GeneratorParam(
    "interfaces",
    f"folders with message definitions, separated by {os.pathsep!r}",
    mandatory=False,
)


class Generator(GeneratorDesc):  # type: ignore[misc]  # textX has no type hints
    """A target of one language: call it with a typed model to get the files.

    Attributes:
        language: textX name of the language, ``rosnode``, ``rossystem`` or ``deros``.
        target: what it makes, unique within the language.
        description: the docstring's first paragraph on one line.
        options: what it takes on the command line, all optional.
        project_name: distribution that brought it, once discovered.
    """

    language: str
    target: str
    description: str
    project_name: str | None
    project_version: str | None

    def __init__(
        self, language: str, target: str, function: GenerateFunction, options: Sequence[Option]
    ) -> None:
        """Describe ``function`` to textX and to ourselves."""
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
            GenerationError: if this target cannot be made from the model.
            ValueError: if an option is not one of :attr:`options`.
        """
        given = dict(options or {})
        if unknown := sorted(given.keys() - {option.name for option in self.options}):
            raise ValueError(
                f"{self.language} -> {self.target} has no option {', '.join(map(repr, unknown))}"
            )
        files = self.function(model, context, given)
        _check_path_lengths(files, model)
        return files

    def __repr__(self) -> str:
        """Name language and target."""
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
        """Load, check, generate and write one file, as ``textx generate`` wants it done.

        The metamodels of our languages know how (``run_generator``), since that needs more than a
        generator may import.

        Raises:
            TextXError: with all diagnostics as its text; textX prints it and exits with 1.
        """
        filename = getattr(model, "_tx_filename", None)
        if not filename:
            raise TextXError(f"{self.language} -> {self.target} needs a model from a file")
        names = {_argument(option.name): option.name for option in self.options}
        interfaces = str(custom_args.pop("interfaces", ""))
        folders = tuple(Path(each) for each in interfaces.split(os.pathsep) if each)
        options = {names.get(name, name): str(value) for name, value in custom_args.items()}
        metamodel.run_generator(self, filename, options, folders, output_path, overwrite)


def generator(
    language: str, target: str, options: Sequence[Option] = ()
) -> Callable[[GenerateFunction], Generator]:
    """Make a generator of a function from typed model, context and options to files.

    The function's docstring becomes the description. Name the decorated object by an entry point
    in the group ``textx_generators``::

        [project.entry-points.textx_generators]
        rossystem_dot = "my_package:dot"
    """

    def decorate(function: GenerateFunction) -> Generator:
        return Generator(language, target, function, options)

    return decorate


def _check_path_lengths(files: Files, model: Any) -> None:
    """Refuse files that no file system could hold, before any of them is written.

    Raises:
        GenerationError: names of the model make the name of a file too long.
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
    """An entry point that could not be used, and why; it takes nothing else down with it."""

    entry_point: str
    distribution: str
    reason: str


@dataclass(frozen=True, slots=True)
class Registry:
    """All generators of the environment, in order of language and target."""

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
    """Load the generators that the installed distributions name.

    Generators of other textX languages in the same group are passed over. When two distributions
    claim one target, ours wins, then the first by name.
    """
    found: dict[tuple[str, str], Generator] = {}
    broken: list[BrokenPlugin] = []
    for point in sorted(entry_points(group=GROUP), key=_own_first):
        distribution = point.dist.name if point.dist else "?"
        try:
            loaded = point.load()
        except Exception as error:  # a plug-in may fail in any way it likes
            reason = f"{type(error).__name__}: {error}"
            broken.append(BrokenPlugin(point.name, distribution, reason))
            continue
        if not isinstance(loaded, Generator):
            continue
        loaded.project_name = distribution
        loaded.project_version = point.dist.version if point.dist else None
        other = found.setdefault((loaded.language, loaded.target), loaded)
        if other is not loaded:
            reason = f"{loaded.language} -> {loaded.target} is taken by {other.project_name}"
            broken.append(BrokenPlugin(point.name, distribution, reason))
    return Registry(tuple(found[key] for key in sorted(found)), tuple(broken))


def _own_first(point: EntryPoint) -> tuple[bool, str, str]:
    name = point.dist.name if point.dist else ""
    return name != "deros", name, point.name


def _argument(option: str) -> str:
    """Return an option's name as textX passes it on."""
    return option.replace("-", "_")
