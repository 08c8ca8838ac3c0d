"""Checks models as ``deros check`` does."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path

from deros.diagnostics import Diagnostic
from deros.interfaces.store import InterfaceStore
from deros.metamodels.load import Repository
from deros.validators.check import check
from tests.support.rules import embedded_store


def checked(
    *files: str | Path,
    texts: Mapping[Path, str] | None = None,
    store: InterfaceStore | None = None,
) -> list[Diagnostic]:
    """Return the findings of files.

    Args:
        files: the files that are named; what they import is checked with them.
        texts: files that have other text than on disk, or are not there.
        store: the message definitions; by default those of the package, as on every machine.
    """
    repository = Repository()
    for path, text in (texts or {}).items():
        repository.load_text(path, text)
    return check([repository.load(file) for file in files], repository, store or embedded_store())


def checked_rules(rules: str, system: str, folder: Path) -> list[Diagnostic]:
    """Return the findings of rules that use ``robot.system``; both are written to a folder."""
    (folder / "robot.system").write_text(system, encoding="utf-8")
    (folder / "rules.deros").write_text(rules, encoding="utf-8")
    return checked(folder / "rules.deros")


def found_in_rules(code: str, rules: str, system: str, folder: Path) -> list[Diagnostic]:
    """Return the findings of one code, such as ``DRS380``, in rules that have no errors."""
    findings = checked_rules(rules, system, folder)
    assert not [each for each in findings if each.is_error], findings
    return [each for each in findings if each.code.name == code]
