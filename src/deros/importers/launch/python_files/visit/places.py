"""Folders of packages, which launch files ask for by name and join to paths."""

from __future__ import annotations

import functools
from collections.abc import Callable, Mapping
from importlib import import_module
from pathlib import Path
from typing import Any

from deros.importers.launch.python_files.visit.texts import PLACES, Call

_ASKED: Mapping[str, str] = {
    "get_package_prefix": "find-pkg-prefix",
    "get_package_share_directory": "find-pkg-share",
}
"""The functions of ament, and what a text in XML has for what they return."""


def note(file: str) -> None:
    """Note the folder of a launch file, and from now on all folders that it asks for.

    It has to come before whatever imports these functions.
    """
    PLACES[str(Path(file).parent)] = Call("dirname")
    package: Any = import_module("ament_index_python")
    packages: Any = import_module("ament_index_python.packages")
    for name, word in _ASKED.items():
        noting = _noting(getattr(packages, name), word)
        for module in (package, packages):
            setattr(module, name, noting)


def _noting(function: Callable[..., Any], word: str) -> Callable[..., Any]:
    @functools.wraps(function)
    def asked(package_name: str, *others: Any, **named: Any) -> Any:
        found = function(package_name, *others, **named)
        PLACES[str(found)] = Call(word, ((package_name,),))
        return found

    return asked
