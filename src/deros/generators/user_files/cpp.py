"""The classes in the user's C++ files, read with clang if it is installed, else by patterns.

clang parses a header without its includes: it recovers from unknown types, and its syntax tree has
every method with its location.
"""

from __future__ import annotations

import json
import re
import shutil
import subprocess
from collections.abc import Iterator, Mapping
from typing import Any

from deros.diagnostics import SourceFile, Span
from deros.generators.api.protocol import Files, Owner
from deros.generators.user_files.classes import HOOKS, Base, Name, Written

_CLASS = re.compile(
    r"\b(?:class|struct)\s+(\w+)(?:\s+final)?\s*:\s*(?:public\s+)?(?:\w+\s*::\s*)*(\w+)"
)
_PURE = re.compile(r"\bvirtual\b[^;{}]*?\b(\w+)\s*\([^;{}]*\)[^;{}()]*=\s*0\s*;")
_WORD = re.compile(r"\b[A-Za-z_]\w*\b")
_OVERRIDE = re.compile(
    r"\b(\w+)\s*\((?:[^(){};]|\([^(){};]*\))*\)\s*(?:const\s*)?(?:noexcept\s*)?(?:override|final)\b"
)
_STRUCT = re.compile(r"\bstruct\s+Parameters\s*\{(.*?)\n  \};", re.DOTALL)
_FIELD = re.compile(r"\b(\w+)\s*(?:\{[^;]*\})?;")
_READ = re.compile(r"\bparameters\(\)\s*->\s*(\w+)")
_USE = re.compile(r"(?<![\w.>:])(?:this\s*->\s*)?((?:publish|call|send|client|timer)_\w+)")
_NOISE = re.compile(
    r'//[^\n]*|/\*.*?\*/|R"(?P<mark>[^(]{0,16})\(.*?\)(?P=mark)"|"(?:\\.|[^"\\\n])*"|'
    r"'(?:\\.|[^'\\\n])+'",
    re.DOTALL,
)
_TIMEOUT_S = 20
_FATAL = "the class is abstract, and the package does not compile"


def cpp_classes(files: Files, present: Mapping[str, SourceFile]) -> Iterator[tuple[Base, Written]]:
    """Yield the generated base class and the user's class of each header of the user.

    Args:
        files: the files that a generator returned.
        present: the user's files, as they are on the disk.
    """
    headers = {
        path: file.text
        for path, file in files.items()
        if path.endswith(".hpp") and file.owner is Owner.GENERATOR
    }
    for path, source in present.items():
        if not path.endswith(".hpp"):
            continue
        stub = _CLASS.search(_code(files[path].text))
        text = _code(source.text)
        found = next((m for m in _CLASS.finditer(text) if stub and m[2] == stub[2]), None)
        if stub is None or found is None:
            continue
        generated = next((h for h in headers.values() if f"class {stub[2]} " in h), None)
        generated = generated or next(
            (h for h in headers.values() if re.search(rf"\bclass\s+{stub[2]}\b", h)), None
        )
        if generated is not None:
            bodies = [
                each
                for other, each in present.items()
                if other.endswith(".cpp") and _stem(other) == _stem(path)
            ]
            yield _base(stub[2], generated), _written(found, text, source, bodies)


def _base(name: str, header: str) -> Base:
    code = _code(header)
    struct = _STRUCT.search(code)
    fields = frozenset(_FIELD.findall(struct[1])) if struct else None
    return Base(name, tuple(_PURE.findall(code)), frozenset(_WORD.findall(code)), fields, _FATAL)


def _written(
    found: re.Match[str], text: str, source: SourceFile, bodies: list[SourceFile]
) -> Written:
    start, end = found.end(), _closing(text, found.end())
    words = frozenset(_WORD.findall(text[start:end]))
    methods = _declared(found[1], source)
    if methods is None:
        methods = [
            Name(m[1], Span(source, start + m.start(1), start + m.end(1)))
            for m in _OVERRIDE.finditer(text[start:end])
        ]
    used, parameters = [], []
    for each in (source, *bodies):
        code = _code(each.text)
        used += [Name(m[1], Span(each, *m.span(1))) for m in _USE.finditer(code)]
        parameters += [Name(m[1], Span(each, *m.span(1))) for m in _READ.finditer(code)]
    overridden = {m[1] for m in _OVERRIDE.finditer(text[start:end])}
    # A method that overrides nothing is the user's own; other code may call it.
    overriding = [each for each in methods if each.text in overridden and each.text not in HOOKS]
    name = Name(found[1], Span(source, *found.span(1)))
    known = words - {each.text for each in overriding}
    return Written(
        name,
        tuple(overriding),
        known,
        tuple(used),
        tuple(parameters),
        True,
        found[2].endswith("ActionsBase"),
    )


def _declared(name: str, source: SourceFile) -> list[Name] | None:
    """Return the methods of a class that clang finds, or ``None`` without a result from clang."""
    clang = shutil.which("clang++")
    if clang is None:
        return None
    # Included headers may be missing here, and their contents do not matter.
    text = re.sub(
        r"(?m)^[ \t]*#[ \t]*include\b[^\n]*", lambda m: " " * len(m[0].encode()), source.text
    )
    command = [clang, "-x", "c++", "-std=c++17", "-nostdinc", "-nostdinc++", "-fsyntax-only", "-w"]
    command += ["-ferror-limit=0", "-Xclang", "-ast-dump=json", "-Xclang"]
    command += [f"-ast-dump-filter={name}", "-"]
    try:
        done = subprocess.run(
            command, input=text.encode(), capture_output=True, timeout=_TIMEOUT_S, check=False
        )
        found = list(_methods(done.stdout.decode(errors="replace"), name))
    except (OSError, subprocess.TimeoutExpired, ValueError, RecursionError):
        return None
    data = text.encode()
    named = []
    for method, offset in found:
        start = len(data[:offset].decode(errors="replace"))
        if source.text[start : start + len(method)] == method:
            named.append(Name(method, Span(source, start, start + len(method))))
    return named or None


def _methods(dump: str, name: str) -> Iterator[tuple[str, int]]:
    """Yield the names and byte offsets of the methods in the dump of a class."""
    decoder = json.JSONDecoder()
    at = dump.find("{")
    while at >= 0:
        tree, end = decoder.raw_decode(dump, at)
        if tree.get("kind") == "CXXRecordDecl" and tree.get("name") == name:
            for each in tree.get("inner", ()):
                offset = _offset_of(each)
                if each.get("kind") == "CXXMethodDecl" and offset is not None:
                    yield each["name"], offset
        at = dump.find("{", end)


def _offset_of(node: dict[str, Any]) -> int | None:
    place = node.get("loc", {})
    place = place.get("spellingLoc", place)
    offset = place.get("offset")
    return (
        offset if isinstance(offset, int) and "file" not in place.get("includedFrom", {}) else None
    )


def _code(text: str) -> str:
    """Return a text with comments and literals replaced by blanks, so that offsets stay valid."""
    return _NOISE.sub(lambda found: re.sub(r"[^\n]", " ", found[0]), text)


def _closing(text: str, start: int) -> int:
    """Return the end of the class whose head ends at ``start``."""
    depth = 0
    for found in re.compile(r"[{}]").finditer(text, start):
        depth += 1 if found[0] == "{" else -1
        if depth == 0:
            return found.end()
    return len(text)


def _stem(path: str) -> str:
    return path.rpartition("/")[2].rpartition(".")[0]
