"""Files that a system names and that cannot be used."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

from deros.diagnostics import Code, Diagnostic, Related, Span, report
from deros.interfaces.files import entries, is_folder
from deros.models.parameter_files import Fault, Missing, NotInstalled
from deros.names.names import did_you_mean, near


@dataclass(frozen=True, slots=True)
class Kind:
    """A kind of file.

    Attributes:
        missing: the code of one that cannot be read.
        unchecked: of one in a package that is not installed.
        unfit: of one that holds something else.
        purpose: the words for what is done with it, at the place where it is named.
    """

    missing: Code
    unchecked: Code
    unfit: Code
    purpose: str


def unusable(path: str, place: Span, found: object, kind: Kind) -> Iterator[Diagnostic]:
    """Yield why a file cannot be used.

    Args:
        path: as the system names it.
        place: where it does.
        found: what became of reading it; of anything but a fault, there is no finding.
        kind: of the file.
    """
    match found:
        case Missing(absolute, reason):
            message = reason or f"there is no file '{path}'"
            hint = "" if reason else _alike(Path(absolute))
            yield report(kind.missing, message, place, hint)
        case NotInstalled(package):
            yield report(
                kind.unchecked,
                f"'{path}' has not been checked: package '{package}' is not installed here",
                place,
                "check the system where AMENT_PREFIX_PATH names its install space",
            )
        case Fault(message, span, hint):
            yield report(kind.unfit, message, span, hint, (Related(place, kind.purpose),))


def _alike(path: Path) -> str:
    if not is_folder(path.parent):
        return "its folder does not exist either"
    names = [each.name for each in entries(path.parent) if not each.is_folder]
    alike = near(path.name, (each for each in names if each.endswith(path.suffix)))
    return did_you_mean(alike or near(path.name, names), path.name)
