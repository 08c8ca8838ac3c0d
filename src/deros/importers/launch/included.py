"""What is known of a launch file that another one includes."""

from __future__ import annotations

import os
from collections.abc import Collection
from pathlib import Path

from deros.importers.launch.elements import element_of
from deros.importers.launch.scopes import File
from deros.importers.readers import UnreadableError
from deros.metamodels.launch_files.contents import document
from deros.metamodels.launch_files.elements import NotALaunchFile
from deros.models.arguments import Expression, Literally

_READ = (".xml", ".yaml", ".yml")
LAUNCH_ENDINGS = (".py", *_READ)
"""By which launch knows what a file is written in."""


def taken(file: File, path: Expression) -> Collection[str] | None:
    """Return the arguments that an included file takes; ``None``: it may take any.

    One in XML or YAML that cannot be read here takes what it is given, and no more.
    """
    if not isinstance(path, Literally) or not str(path.value).endswith(_READ):
        return None
    place = Path(str(path.value))
    if str(path.value).startswith("share:"):
        return None
    try:
        root = element_of(Path(os.path.normpath(file.output / place)))
        found = document(root.span.source, str(place), root)
    except (UnreadableError, NotALaunchFile):
        return None
    return {*found.arguments, *found.used} if found.is_complete else None
