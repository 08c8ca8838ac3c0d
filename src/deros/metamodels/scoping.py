"""References across files: one index of names per file, and the textX scope providers that use it.

textX's own resolution searches the whole model for every reference and stops at the first unknown
name. Here a reference is one look-up, and an unknown name is an answer too: the converters turn it
into a diagnostic, so that all of them are reported together.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any, Generic, Protocol, TypeVar

if TYPE_CHECKING:
    from deros.metamodels.matching import Token
    from deros.models.node import NodeType
    from deros.models.system import System


class _Named(Protocol):
    @property
    def name(self) -> str: ...


T = TypeVar("T")
N = TypeVar("N", bound=_Named)


@dataclass(frozen=True, slots=True)
class Reference(Generic[T]):
    """A name in a model and its candidates: exactly one if the name is unambiguous."""

    name: Token
    candidates: tuple[T, ...]

    @property
    def target(self) -> T | None:
        """The element meant, or ``None`` when no import defines the name."""
        return self.candidates[0] if self.candidates else None


@dataclass(slots=True)
class FileIndex:
    """The definitions in the imports of one file, by name.

    ``complete`` is false when an import could not be loaded: then unknown names are not reported.
    """

    node_types: dict[str, tuple[NodeType, ...]] = field(default_factory=dict)
    systems: dict[str, tuple[System, ...]] = field(default_factory=dict)
    complete: bool = True

    def add_node_type(self, node_type: NodeType) -> None:
        """Index a node type by name; one file imported twice counts once."""
        _add(self.node_types, node_type)

    def add_system(self, system: System) -> None:
        """Index a system by name; one file imported twice counts once."""
        _add(self.systems, system)


def _add(names: dict[str, tuple[N, ...]], element: N) -> None:
    known = names.get(element.name, ())
    if not any(element is each for each in known):
        names[element.name] = (*known, element)


_NO_IMPORTS = FileIndex()


def attach_index(model: Any, index: FileIndex) -> None:
    """Attach the index of its imports to a textX model before references are resolved."""
    model._deros_index = index


def _provider(
    names: Callable[[FileIndex], Mapping[str, tuple[T, ...]]],
) -> Callable[[Any, Any, Any], Reference[T]]:
    def provide(model_object: Any, _attribute: Any, reference: Any) -> Reference[T]:
        root = model_object
        while hasattr(root, "parent"):
            root = root.parent
        index: FileIndex = getattr(root, "_deros_index", _NO_IMPORTS)
        name = reference.obj_name
        return Reference(name, names(index).get(name, ()))

    return provide


SCOPE_PROVIDERS: dict[str, Callable[[Any, Any, Any], Reference[Any]]] = {
    "NodeInstance.type": _provider(lambda index: index.node_types),
    "Subsystem.system": _provider(lambda index: index.systems),
    "Use.system": _provider(lambda index: index.systems),
}
"""The scope providers by the attribute that they resolve, as textX registers them."""
