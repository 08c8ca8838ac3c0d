"""deros as a plug-in of textX: the three languages, and the command group.

``textx check`` and ``textx generate`` load a model through its language's metamodel; here that
means our own loader and all our checks. The generators are in :mod:`deros.generators.builtin`.
"""

from __future__ import annotations

import functools
import sys
from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

from deros.metamodels.textx_registration import LanguageDesc, TextXError

if TYPE_CHECKING:
    import click

    from deros.diagnostics import Diagnostic
    from deros.generators.api.protocol import Context
    from deros.interfaces.store import InterfaceStore
    from deros.metamodels.languages import Language
    from deros.metamodels.load import LoadedFile


def add_commands(textx: click.Group) -> None:
    """Offer ``deros`` and its commands as ``textx deros …``, and let generators use our checks."""
    from deros.cli.main import deros

    textx.add_command(deros)


def _checked_metamodel(language: Language) -> Any:
    """Return the language's metamodel, whose models are checked before anybody gets them."""
    from deros.generators.api.registry import use_front_end
    from deros.metamodels.languages import metamodel

    result = metamodel(language)
    parse = result.model_from_file

    @functools.wraps(parse)
    def model_from_file(file_name: str, *args: Any, **kwargs: Any) -> Any:
        _check(file_name)
        return parse(file_name, *args, **kwargs)

    result.model_from_file = model_from_file
    use_front_end(_errors, _render, _findings_of)
    return result


def _check(file_name: str) -> None:
    """Check one file; what is not in the way goes to standard error.

    Raises:
        TextXError: with all findings as its text, if one of them is in the way.
    """
    import click

    from deros.cli.check import find
    from deros.diagnostics import has_errors
    from deros.pipeline.outcome import blocking_diagnostics

    findings = find([file_name], ()).findings
    command = click.get_current_context(silent=True)
    generates = command is not None and command.info_name == "generate"
    if has_errors(blocking_diagnostics(findings, file_name) if generates else findings):
        raise TextXError(f"{file_name} has errors\n{_render(findings).rstrip()}")
    if findings:
        sys.stderr.write(_render(findings))


def _errors(loaded: LoadedFile, context: Context) -> list[Diagnostic]:
    """Check a file that a generator was asked for; its warnings were shown when it was loaded."""
    from deros.pipeline.outcome import blocking_diagnostics
    from deros.validators.check import check

    findings = check([loaded], context.repository, context.store)
    return [d for d in blocking_diagnostics(findings, loaded.path) if d.is_error]


def _findings_of(loaded: LoadedFile, store: InterfaceStore) -> list[Diagnostic]:
    """Check a file that a generator loads besides its model."""
    from deros.validators.check import check_file

    return check_file(loaded, store)


def _render(diagnostics: Sequence[Diagnostic]) -> str:
    from deros.report.text import render_text

    return render_text(diagnostics)


def _language(name: Language, pattern: str, description: str) -> Any:
    return LanguageDesc(name, pattern, description, functools.partial(_checked_metamodel, name))


rosnode = _language("rosnode", "*.rnd", "ROS 2 node descriptions: parameters and ports of a node")
rossystem = _language("rossystem", "*.system", "ROS 2 systems: nodes, topics and their wiring")
deros = _language("deros", "*.deros", "DeRoS safety rules: what must not happen, and what then")
