"""deros as a plug-in of textX: its languages and its commands.

``textx check`` and ``textx generate`` load a model through its language's metamodel; here that
means our own loader and all our checks. The generators are in :mod:`deros.generators.builtin`.
"""

from __future__ import annotations

import functools
import sys
import time
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

from deros.metamodels.languages import language_named
from deros.metamodels.textx_registration import LanguageDesc, TextXError

if TYPE_CHECKING:
    import click

    from deros.diagnostics import Diagnostic
    from deros.generators.api.registry import Generator
    from deros.metamodels.languages import Language


def add_commands(textx: click.Group) -> None:
    """Offer ``deros`` and its commands as ``textx deros …``."""
    from deros.cli.main import deros
    from deros.cli.streams import write_readably

    write_readably()
    textx.add_command(deros)


def _checked_metamodel(language: Language) -> Any:
    """Return the language's metamodel, which checks each model before it returns it."""
    from deros.metamodels.parsers import metamodel

    result = metamodel(language)
    parse = result.model_from_file

    @functools.wraps(parse)
    def model_from_file(file_name: str, *args: Any, **kwargs: Any) -> Any:
        _check(file_name)
        return parse(file_name, *args, **kwargs)

    result.model_from_file = model_from_file
    result.run_generator = _run_generator
    return result


def _check(file_name: str) -> None:
    """Check one file; write findings that do not block generating to standard error.

    Raises:
        TextXError: with all findings as its text, if one of them is blocking.
    """
    import click

    from deros.cli.commands.check import find
    from deros.diagnostics import has_errors
    from deros.pipeline.outcome import blocking_diagnostics

    findings = find([file_name], ()).findings
    command = click.get_current_context(silent=True)
    generates = command is not None and command.info_name == "generate"
    if has_errors(blocking_diagnostics(findings, file_name) if generates else findings):
        raise TextXError(f"{file_name} has errors\n{_render(findings).rstrip()}")
    if findings:
        sys.stderr.write(_render(findings))


def _run_generator(
    generator: Generator,
    filename: str,
    options: Mapping[str, str],
    interfaces: tuple[Path, ...],
    output_path: str | None,
    overwrite: bool,
) -> None:
    """Load, check, generate and write.

    Args:
        generator: the generator to run.
        filename: the model's file.
        options: those of the generator, by their declared names.
        interfaces: folders with message definitions.
        output_path: the folder to write to; ``None`` for that of the model.
        overwrite: whether generated files that were edited by hand are replaced.

    Raises:
        TextXError: with the errors as its text.
    """
    from deros.cli.interrupts import held
    from deros.generators.api.protocol import OptionError
    from deros.generators.output.writer import WriteError
    from deros.pipeline.generate import Refused, Request, generate
    from deros.pipeline.output import OutputSpec, write

    started_ns = time.time_ns()
    spec = OutputSpec(Path(output_path) if output_path else Path(filename).parent, overwrite)
    try:
        generated = generate(
            Request(_as_named(filename), generator.target, options, interfaces, generator)
        )
        with held():
            written = write(generated, spec, started_ns)
    except Refused as refused:
        errors = [each for each in refused.diagnostics if each.is_error]
        raise TextXError(_render(errors).rstrip()) from refused
    except (WriteError, OptionError) as error:
        raise TextXError(str(error)) from error
    warnings = written.diagnostics  # those of the model were shown when it was loaded
    if warnings:
        sys.stderr.write(_render(warnings).rstrip() + "\n")
    for note in written.notes:
        sys.stdout.write(f"{note}\n")


def _as_named(filename: str) -> str:
    """Return the path relative to the working folder if it lies there, as users name files."""
    path = Path(filename)
    here = Path.cwd()
    return str(path.relative_to(here)) if path.is_relative_to(here) else filename


def _render(diagnostics: Sequence[Diagnostic]) -> str:
    from deros.report.text import render_text

    return render_text(diagnostics)


def __getattr__(name: str) -> Any:
    """Return the language of that name, as the group ``textx_languages`` of entry points asks."""
    language = language_named(name)
    if language is None:
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    metamodel = functools.partial(_checked_metamodel, language)
    return LanguageDesc(language.name, language.pattern, language.description, metamodel)
