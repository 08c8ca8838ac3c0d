"""NoDL 2: the interface of a node, as YAML or JSON.

Source: ``nodl.schema.yaml`` of ros-tooling/nodl, version 2.
"""

from __future__ import annotations

import re
from collections.abc import Iterator
from pathlib import Path

from deros.diagnostics import Span
from deros.importers import node_text
from deros.importers.formats import loading
from deros.importers.formats.draft import Draft
from deros.importers.formats.names import UniqueNames
from deros.importers.formats.nodl_qos import read_qos
from deros.importers.formats.parameters import declare
from deros.importers.readers import Request, UnreadableError, source_of
from deros.importers.results import Imported, Missing, Parts
from deros.interfaces.files import is_file, read_regular, real_path
from deros.interfaces.types import InterfaceKind, InterfaceType
from deros.metamodels.yaml_trees.tree import Mapping, Scalar, Sequence, Tree
from deros.models.node import PortKind
from deros.names.names import check_package_name

SECTIONS: dict[str, tuple[PortKind, InterfaceKind]] = {
    "publishers": (PortKind.PUBLISHER, "msg"),
    "subscriptions": (PortKind.SUBSCRIPTION, "msg"),
    "service_servers": (PortKind.SERVICE, "srv"),
    "service_clients": (PortKind.CLIENT, "srv"),
    "action_servers": (PortKind.ACTION, "action"),
    "action_clients": (PortKind.ACTION_CLIENT, "action"),
}
"""The keys of ports, with their kinds and the kinds of their types."""

_VERSION = "nodl_version"
_LOCAL = "local://"
_MOST = 50
"""The most documents of a node."""

_ENDING = re.compile(r"\.nodl\.(?:ya?ml|json)\Z")
_TYPE = re.compile(r"([A-Za-z]\w*)/(?:(msg|srv|action)/)?([A-Z][A-Za-z0-9]*)", re.ASCII)
_PACKAGE = re.compile(rb"<name>\s*([a-z0-9_]+)\s*</name>")
_LARGEST_PACKAGE = 1 << 20
_WHY = "A NoDL document does not name the program: write the right one here."


def is_nodl(path: Path) -> bool:
    """Return whether a file is a NoDL document of any version: by its name, or by its version."""
    if _ENDING.search(path.name) or path.name.endswith(".nodl.xml"):
        return True
    if path.suffix not in (".yaml", ".yml", ".json"):
        return False
    top = loading.top_of(path)
    return top is not None and _VERSION in top.entries


def read_nodl(request: Request) -> Imported:
    """Return a node description for each document.

    Raises:
        UnreadableError: if one is no document of version 2.
    """
    files: dict[str, Parts] = {}
    missing: list[Missing] = []
    names = UniqueNames()
    for path in request.files:
        name = request.name if len(request.files) == 1 else None
        stem = _ENDING.sub("", path.name).removesuffix(path.suffix)
        draft = Draft(names.of(name or stem), _package_of(path) or node_text.UNKNOWN_PACKAGE)
        description = _Document(draft).read(path)
        draft.clean(request.store)
        node = draft.node
        head = node_text.head(node.name, node.package, node.name, _WHY, description)
        files[f"nodes/{node.name}.rnd"] = draft.parts(head)
        missing += draft.missing
    return Imported(files, tuple(map(str, missing)))


def _package_of(path: Path) -> str | None:
    """Return the package whose folder a document is in."""
    for folder in path.absolute().parents:
        manifest = folder / "package.xml"
        if not is_file(manifest):
            continue
        try:
            found = _PACKAGE.search(read_regular(manifest, _LARGEST_PACKAGE))
        except (OSError, ValueError):
            return None
        name = found[1].decode() if found else ""
        return name if not check_package_name(name) else None
    return None


class _Document:
    """Reads a document, and those that it includes, for one node."""

    def __init__(self, draft: Draft) -> None:
        self._draft = draft
        self._read: set[Path] = set()

    def read(self, path: Path) -> str:
        """Add what a document says to the draft; return its description of the node."""
        if path.name.endswith(".nodl.xml"):
            raise UnreadableError(
                f"{path}: this is NoDL 1; documents of version 2 are YAML or JSON"
            )
        top = loading.mapping_of(source_of(path))
        version = top.get(_VERSION)
        if not isinstance(version, Scalar) or version.value != 2:
            found = version.span if version is not None else top.span
            raise loading.unreadable_at(found, f"this is not NoDL of version 2, '{_VERSION}: 2'")
        self._draft.missing += loading.unused_keys(top)
        self._read.add(Path(real_path(path)))
        for key, value in top.entries.items():
            if key in SECTIONS:
                self._ports(key, value)
            elif key == "parameters":
                self._parameters(value)
            elif key == "include":
                self._includes(path, value)
            elif key not in (_VERSION, "description"):
                why = "is left out: it is for generators of code" if key == "codegen" else ""
                self._lack(f"'{key}'", why or "is left out: it is not known", top.keys[key])
        description = top.get("description")
        return " ".join(description.text.split()) if isinstance(description, Scalar) else ""

    def _lack(self, what: str, why: str, span: Span) -> None:
        self._draft.lack(what, why, span)

    def _parameters(self, tree: Tree) -> None:
        if not isinstance(tree, Mapping):
            self._lack("'parameters'", "has no keys", tree.span)
            return
        for name, said in tree.entries.items():
            place = tree.keys[name]
            if "<" in name or ">" in name:
                self._lack(f"parameter '{name}'", "is left out: a name has no '<' or '>'", place)
            elif isinstance(said, Mapping):
                declare(self._draft, name, said, place)
            else:
                self._lack(f"parameter '{name}'", "is left out: nothing is said of it", place)

    def _includes(self, path: Path, tree: Tree) -> None:
        for each in self._items("'include'", tree):
            found = each.get("ref")
            ref = found.text if isinstance(found, Scalar) else ""
            what = f"document '{ref}'"
            # A reference is a path of a checkout, or what an installed package has registered.
            other = path.parent / ref.removeprefix(_LOCAL)
            if not ref.startswith(_LOCAL):
                why = "is left out: give the document of that package, in place of the reference"
                self._lack(what, why, each.span)
            elif len(self._read) == _MOST:
                self._lack(what, f"is left out: {_MOST} documents are read already", each.span)
            elif not is_file(other):
                self._lack(what, "is left out: there is no such file", each.span)
            elif Path(real_path(other)) in self._read:
                self._lack(what, "is left out: it is included already", each.span)
            else:
                self.read(other)

    def _items(self, what: str, tree: Tree) -> Iterator[Mapping]:
        if not isinstance(tree, Sequence):
            self._lack(what, "has no list", tree.span)
            return
        for each in tree.items:
            if isinstance(each, Mapping):
                yield each
            else:
                self._lack(f"an entry of {what}", "has no keys", each.span)

    # Ports ---------------------------------------------------------------------------------------

    def _ports(self, section: str, tree: Tree) -> None:
        kind, interface = SECTIONS[section]
        for each in self._items(f"'{section}'", tree):
            self._port(kind, interface, each)

    def _port(self, kind: PortKind, interface: InterfaceKind, tree: Mapping) -> None:
        words = {
            key: value.text for key, value in tree.entries.items() if isinstance(value, Scalar)
        }
        name, written = words.get("name", ""), words.get("type", "")
        what = f"{kind.word} '{name}'"
        found = _TYPE.fullmatch(written)
        if found is None or found[2] not in (None, interface):
            why = f"is left out: '{written}' is no type of a {kind.word}"
            self._lack(what, why, tree.span)
            return
        qos = tree.get("qos")
        profile = read_qos(self._draft, what, qos) if qos is not None else None
        for key, value in tree.entries.items():
            if key not in ("name", "type", "qos", "description"):
                self._lack(what, f"has '{key}', which is not known", value.span)
        of_type = InterfaceType(found[1], interface, found[3])
        text = " ".join(words.get("description", "").split())
        self._draft.add_port(kind, name, of_type, tree.span, profile, text)
