"""Which module of deros imports what."""

from __future__ import annotations

from functools import cache

import grimp


@cache
def imports(*, of_types: bool = True) -> grimp.ImportGraph:
    """Return the imports of all modules, lazy ones too; other libraries by their first names.

    Args:
        of_types: with those that only a type checker reads.
    """
    return grimp.build_graph(
        "deros",
        include_external_packages=True,
        exclude_type_checking_imports=not of_types,
        cache_dir=None,
    )
