"""The context in which the checks of a language run."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from deros.interfaces.store import InterfaceStore
    from deros.models.rules import Rules
    from deros.rules.compiler.build_cache import BuildCache


@dataclass(frozen=True, slots=True)
class CheckContext:
    """The inputs of a check besides its model.

    Attributes:
        store: the definitions of messages.
        builds: the rules built so far in this run.
        is_whole: whether the model stands on its own: the user named it, or rules use it. A system
            that only another system imports does not.
        rules: the rules that use the system.
        rules_of_parts: the rules that use a system that it contains.
    """

    store: InterfaceStore
    builds: BuildCache
    is_whole: bool = False
    rules: tuple[Rules, ...] = ()
    rules_of_parts: tuple[Rules, ...] = ()
