"""Load, check and generate; nothing is written yet."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import TYPE_CHECKING

from deros.generators.api.protocol import OptionError
from deros.pipeline.known_options import known_options
from deros.pipeline.outcome import FINDINGS, UNUSABLE, blocking_diagnostics, exit_code

if TYPE_CHECKING:
    from collections.abc import Sequence

    from deros.diagnostics import Diagnostic
    from deros.generators.api.protocol import Context, Files
    from deros.generators.api.registry import Generator, Registry
    from deros.metamodels.load import LoadedFile


class Refused(Exception):  # noqa: N818 - it carries findings and is not an error of the program
    """Nothing is generated; ``diagnostics`` says why, and ``code`` is the exit code."""

    def __init__(self, diagnostics: Sequence[Diagnostic], code: int) -> None:
        """Store findings and exit code."""
        self.diagnostics = tuple(diagnostics)
        self.code = code
        super().__init__("; ".join(each.message for each in self.diagnostics))


@dataclass(frozen=True, slots=True)
class Request:
    """A model and a target to generate from it.

    Attributes:
        file: the model's path, as diagnostics are to show it.
        target: which generator.
        options: those of the generator.
        interfaces: folders with message definitions.
        generator: the generator, if the caller has resolved it.
    """

    file: str
    target: str
    options: Mapping[str, str] = field(default_factory=dict)
    interfaces: tuple[Path, ...] = ()
    generator: Generator | None = None


@dataclass(frozen=True, slots=True)
class Generated:
    """The generated files, not written yet, with their generators and findings.

    Attributes:
        files: the files to write.
        context: the context of the generators.
        generators: those that ran.
        findings: the findings in the models, none of them blocking.
        outputs: the model of each generator, and its files.
        rests_on: files besides the models that the result depends on.
        models: of the requests, in their order.
    """

    files: Files
    context: Context
    generators: tuple[Generator, ...]
    findings: tuple[Diagnostic, ...]
    outputs: tuple[tuple[str, Files], ...]
    rests_on: tuple[Path, ...] = ()
    models: tuple[object, ...] = ()


def generate(*requests: Request) -> Generated:
    """Load, check and generate; for several models, all or nothing.

    Raises:
        Refused: if a model has an error, if a target cannot be made from it, or if two of them make
            one file differently.
        OptionError: if a generator cannot read an option; ``UnknownOption`` if none has such a one.
    """
    from deros.generators.api.protocol import GenerationError
    from deros.generators.output.writer import join
    from deros.metamodels.languages import ROSSYSTEM
    from deros.pipeline.workspace import load

    workspace = load([each.file for each in requests], requests[0].interfaces)
    loaded = workspace.files
    findings = workspace.check_models().findings
    # The output of a system needs its gates, so then errors that generating would correct block.
    systems = [each.path for each in loaded if each.language is ROSSYSTEM]
    code = exit_code(blocking_diagnostics(findings, (systems or [loaded[0].path])[0]))
    if code or any(each.language is None for each in loaded):
        raise Refused(findings, code or FINDINGS)
    generators = [_generator(*pair, findings) for pair in zip(requests, loaded, strict=True)]
    options = _options(requests, generators)
    context = workspace.context()
    try:
        outputs = [
            (file.path, generator(file.model, context, given))
            for file, generator, given in zip(loaded, generators, options, strict=True)
        ]
    except GenerationError as error:
        raise Refused([*findings, *error.diagnostics], FINDINGS) from error
    rests_on = tuple(each.path for each in workspace.projects if each.path is not None)
    files = join(outputs)
    return Generated(
        files,
        context,
        tuple(generators),
        tuple(findings),
        tuple(outputs),
        rests_on,
        tuple(each.model for each in loaded),
    )


def _generator(request: Request, loaded: LoadedFile, findings: Sequence[Diagnostic]) -> Generator:
    from deros.generators.api.registry import discover

    if request.generator is not None:
        return request.generator
    assert loaded.language is not None
    generator = discover().find(loaded.language.name, request.target)
    if generator is None:
        unknown = _unknown_target(discover(), loaded, request.target)
        raise Refused([*findings, unknown], UNUSABLE)
    return generator


def _options(
    requests: Sequence[Request], generators: Sequence[Generator]
) -> list[Mapping[str, str]]:
    """Return the options of each generator, from the command line and the project.

    Raises:
        UnknownOption: no generator of the run has an option that the command line gives.
    """
    from deros.pipeline.project import project_of

    _know_options(generators, requests[0].options)
    result: list[Mapping[str, str]] = []
    for request, generator in zip(requests, generators, strict=True):
        given = {**project_of(request.file).options, **request.options}
        result.append(known_options(generator, given))
    return result


class UnknownOption(OptionError):  # noqa: N818 - named after what it is
    """The generator has no option of that name."""

    def __init__(self, name: str, hint: str) -> None:
        """Store the option, with a hint at the nearest ones."""
        self.option = f"--{name}"
        super().__init__(f"No such option: --{name}" + (f"; {hint}" if hint else ""))


def _unknown_target(registry: Registry, loaded: LoadedFile, target: str) -> Diagnostic:
    from deros import codes
    from deros.diagnostics import SourceFile, Span
    from deros.diagnostics import report as finding
    from deros.validators.findings.hints import did_you_mean

    assert loaded.language is not None
    targets = registry.targets(loaded.language.name)
    hint = did_you_mean(target, targets, f"it has {', '.join(targets)}" if targets else "")
    for broken in registry.broken:
        hint += f"; {broken.entry_point} of {broken.distribution} is unusable: {broken.reason}"
    source = loaded.source or SourceFile(loaded.path, "")
    message = f"no generator makes '{target}' from {loaded.language.name}"
    return finding(codes.UNKNOWN_TARGET, message, Span(source, 0, 0), hint.removeprefix("; "))


def _know_options(generators: Sequence[Generator], given: Mapping[str, str]) -> None:
    from deros.validators.findings.hints import did_you_mean

    known = [f"--{option.name}" for generator in generators for option in generator.options]
    for name in given:
        if f"--{name}" not in known:
            raise UnknownOption(
                name, did_you_mean(f"--{name}", [*known, "--overwrite", "--interfaces"])
            )
