"""The examples' own modules, which lie in the packages that they are part of."""

from __future__ import annotations

import importlib
import sys
from pathlib import Path
from typing import Any

EXAMPLES = Path(__file__).resolve().parents[2] / "examples"


def example_module(example: str, name: str) -> Any:
    """Import a module of an example: of its demonstration, or of a package under ``src``."""
    folder = EXAMPLES / example
    for path in [folder, *sorted((folder / "src").iterdir())]:
        if str(path) not in sys.path:
            sys.path.append(str(path))
    return importlib.import_module(name)
