"""What a laser scanner reports where nothing is there, as an ``input`` line declares it."""

from __future__ import annotations

from collections.abc import Iterator

from deros import codes
from deros.diagnostics import Diagnostic, report
from deros.interfaces.fields import FieldError, resolve
from deros.interfaces.store import InterfaceStore
from deros.interfaces.types import FieldType
from deros.models import rules
from deros.rules.compiler.scope import shapes
from deros.rules.compiler.scope.resolved import DeclaredInput
from deros.rules.functions.functions import FUNCTIONS


def declare_no_return(
    store: InterfaceStore, written: rules.Input, declared: DeclaredInput
) -> Iterator[Diagnostic]:
    """Note that 0 means that nothing is there; yield a finding where that cannot be."""
    if written.no_return is None:
        return
    span = written.no_return.span
    if not _is_scan(store, declared):
        yield report(
            codes.BAD_NO_RETURN,
            f"'no_return' tells what a laser scanner reports, '{written.term.span.text}' is no"
            " laser scan",
            span,
            "leave it out",
        )
    elif written.no_return.value != 0:
        yield report(
            codes.BAD_NO_RETURN,
            f"'{span.text}' cannot be what a scanner reports where nothing is there: 0 can",
            span,
            "leave it out: '+Inf' and what lies beyond 'range_max' mean so without it",
        )
    else:
        declared.zero_is_free = True


def _is_scan(store: InterfaceStore, declared: DeclaredInput) -> bool:
    kind = FieldType(declared.type)
    if declared.path:
        found = resolve(store, declared.type, declared.path)
        if isinstance(found, FieldError):
            return False
        kind = found.type
    return shapes.fits(store, FUNCTIONS["nearest"], kind)
