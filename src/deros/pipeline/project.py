"""The project file: settings that the commands of a project share.

It is ``deros.toml``, or the table ``[tool.deros]`` of ``pyproject.toml``, in the folder of a model
or the nearest one above it. The command line takes precedence.
"""

from __future__ import annotations

import re
import sys
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import TYPE_CHECKING, Any

from deros import codes
from deros.diagnostics import Code, Diagnostic, SourceFile, Span, report
from deros.interfaces.files import is_file, is_folder, read_regular, real_path
from deros.metamodels.languages import suffixes
from deros.validators.findings.hints import did_you_mean

if TYPE_CHECKING:
    from deros.validators.findings.allowed import Allowed, ProjectAllowance

if sys.version_info >= (3, 11):
    import tomllib
else:
    import tomli as tomllib

_LARGEST = 4 << 20
_TEXTS = ("copyright", "licence", "maintainer", "runtime")
_KEYS = ("interfaces", "targets", "output", *_TEXTS, "allow")
_ALLOW_KEYS = ("code", "path", "reason")


@dataclass(frozen=True, slots=True)
class Project:
    """The content of a project file.

    Attributes:
        path: the file; ``None`` if there is none.
        interfaces: folders with message definitions, absolute.
        targets: the targets of ``deros generate`` for each language, by suffix.
        output: the folder to write to, absolute; ``None`` if it is not given.
        options: options of generators: copyright, licence, maintainer and runtime.
        allowances: findings that are allowed by code and path.
        diagnostics: the findings about the file.
    """

    path: Path | None = None
    interfaces: tuple[Path, ...] = ()
    targets: Mapping[str, tuple[str, ...]] = field(default_factory=dict)
    output: Path | None = None
    options: Mapping[str, str] = field(default_factory=dict)
    allowances: tuple[ProjectAllowance, ...] = ()
    diagnostics: tuple[Diagnostic, ...] = ()


NONE = Project()


def targets_of(model: str) -> tuple[str, ...]:
    """Return the targets that a model's project names for its language."""
    return project_of(model).targets.get(Path(model).suffix.removeprefix("."), ())


def project_of(model: str | Path) -> Project:
    """Return the project that a model, or a folder of models, belongs to."""
    file = _find(Path(model), {})
    return NONE if file is None else _project(file)


def projects_of(models: Iterable[str | Path]) -> list[Project]:
    """Return the projects that models belong to, each once."""
    known: dict[Path, _ProjectFile] = {}
    found = {file.path: file for model in models if (file := _find(Path(model), known))}
    return [_project(file) for file in found.values()]


def interfaces_of(given: Sequence[Path], projects: Iterable[Project]) -> tuple[Path, ...]:
    """Return the folders of the command line, which take precedence, and of the projects."""
    return (*given, *(folder for project in projects for folder in project.interfaces))


def unneeded(
    projects: Iterable[Project], named: Iterable[str], allowed: Iterable[Allowed]
) -> list[Diagnostic]:
    """Return findings for unneeded allowances of projects that are checked as a whole.

    Args:
        projects: the projects.
        named: what the user named; a project is checked as a whole if its folder is named, or one
            above it.
        allowed: what was allowed.
    """
    needed = {each.by.span for each in allowed}
    folders = [Path(real_path(each)) for each in named if is_folder(each)]
    found = []
    for project in projects:
        if project.path is None or not any(
            Path(real_path(project.path.parent)).is_relative_to(folder) for folder in folders
        ):
            continue
        for each in project.allowances:
            if each.span not in needed:
                message = f"no file of '{each.pattern}' has a finding {each.code} to allow"
                found.append(report(codes.UNUSED_ALLOWANCE, message, each.span, "remove the entry"))
    return found


# Finding and reading -----------------------------------------------------------------------------


@dataclass(frozen=True, slots=True)
class _ProjectFile:
    """A project file as it was read; without ``tables``, ``error`` says why it has none."""

    path: Path
    text: str = ""
    tables: Mapping[str, Any] | None = None
    error: Exception | None = None


def _find(model: Path, known: dict[Path, _ProjectFile]) -> _ProjectFile | None:
    """Return the project file of a model; each file is read once and then ``known``."""
    start = model.absolute()
    for folder in (start, *start.parents) if is_folder(start) else start.parents:
        own, shared = folder / "deros.toml", folder / "pyproject.toml"
        if is_file(own):
            return _parsed(own, known)
        if is_file(shared) and _is_ours(found := _parsed(shared, known)):
            return found
    return None


def _parsed(path: Path, known: dict[Path, _ProjectFile]) -> _ProjectFile:
    if path not in known:
        known[path] = _parse(path)
    return known[path]


def _parse(path: Path) -> _ProjectFile:
    text = ""
    try:
        text = read_regular(path, _LARGEST).decode("utf-8-sig")
        if path.name != "pyproject.toml":
            return _ProjectFile(path, text, tomllib.loads(text))
        return _ProjectFile(path, text, _tool(tomllib.loads(text)) if "deros" in text else {})
    except (OSError, ValueError, RecursionError) as error:  # TOMLDecodeError is a ValueError
        return _ProjectFile(path, text, None, error)


def _is_ours(shared: _ProjectFile) -> bool:
    """Return whether a pyproject.toml has a table for deros, or seems to have one."""
    if shared.tables is not None:
        return "deros" in shared.tables
    header = r"(?m)^\s*\[+\s*tool\s*\.\s*[\"']?deros[\"']?\s*[\].]"
    return re.search(header, shared.text) is not None


def _tool(data: Mapping[str, Any]) -> Mapping[str, Any]:
    """Return the tables of tools of a pyproject.toml, which may be the last ones of a list."""
    tool = data.get("tool", {})
    if isinstance(tool, list) and tool:
        tool = tool[-1]
    return tool if isinstance(tool, dict) else {}


def _project(file: _ProjectFile) -> Project:
    from deros.metamodels.imports import shown_path

    shown = shown_path(str(file.path))
    if file.tables is None:
        error = file.error
        reason = error.strerror if isinstance(error, OSError) and error.strerror else str(error)
        message = f"cannot read the project file '{shown}': {reason}"
        start = Span(SourceFile(shown, ""), 0, 0)
        finding = report(codes.UNREADABLE_PROJECT, message, start)
        return Project(file.path, diagnostics=(finding,))
    shared = file.path.name == "pyproject.toml"
    table = file.tables.get("deros", {}) if shared else file.tables
    return _Reader(file.path, SourceFile(shown, file.text)).project(table)


class _Reader:
    """Reads the table of one project file and collects the findings."""

    def __init__(self, path: Path, source: SourceFile) -> None:
        self._path = path
        self._root = path.parent
        self._source = source
        self._found: list[Diagnostic] = []

    def project(self, table: Any) -> Project:
        if not isinstance(table, dict):
            self._wrong("tool.deros", "is not a table")
            table = {}
        self._unknown(table, _KEYS, "")
        return Project(
            path=self._path,
            interfaces=tuple(self._interfaces(table.get("interfaces", []))),
            targets=self._targets(table.get("targets", {})),
            output=self._output(table.get("output")),
            options={key: text for key in _TEXTS if (text := self._text(table, key)) is not None},
            allowances=tuple(self._allowances(table.get("allow", []))),
            diagnostics=tuple(self._found),
        )

    def _interfaces(self, value: Any) -> Iterator[Path]:
        if not _is_texts(value):
            self._wrong("interfaces", "is not a list of folders")
            return
        for each in value:
            folder = self._root / each
            if is_folder(folder):
                yield folder
            else:
                self._wrong("interfaces", f"names '{each}', and there is no such folder")

    def _targets(self, value: Any) -> dict[str, tuple[str, ...]]:
        if not isinstance(value, dict):
            self._wrong("targets", "is not a table")
            return {}
        languages = [suffix.removeprefix(".") for suffix in suffixes()]
        self._unknown(value, languages, "targets.")
        targets = {}
        for language in languages:
            named = value.get(language, [])
            if isinstance(named, str):
                named = [named]
            if _is_texts(named):
                targets[language] = tuple(dict.fromkeys(named))
            else:
                self._wrong(language, "is neither the name of a target nor a list of names")
        return {language: names for language, names in targets.items() if names}

    def _output(self, value: Any) -> Path | None:
        if value is None:
            return None
        if not isinstance(value, str) or not value:
            self._wrong("output", "is not the path of a folder")
            return None
        folder = self._root / value
        if not Path(real_path(folder)).is_relative_to(real_path(self._root)):
            # A model from somebody else must not choose what is written where.
            hint = "name such a folder on the command line: -o"
            self._wrong("output", f"is '{value}', which is outside the project's folder", hint)
            return None
        return folder

    def _text(self, table: dict[str, Any], key: str) -> str | None:
        value = table.get(key)
        if value is not None and not (isinstance(value, str) and value.strip()):
            self._wrong(key, "is not a string")
            return None
        return value

    def _allowances(self, value: Any) -> Iterator[ProjectAllowance]:
        from deros.validators.findings.allowances import allowable
        from deros.validators.findings.allowed import ProjectAllowance

        if not isinstance(value, list) or not all(isinstance(each, dict) for each in value):
            self._wrong("allow", "is not a list of tables with code, path and reason")
            return
        for number, entry in enumerate(value):
            span = self._entry(number)
            self._unknown(entry, _ALLOW_KEYS, "allow.", span)
            if lacking := [key for key in _ALLOW_KEYS if not _is_text(entry.get(key))]:
                message = (
                    f"an allowance needs {', '.join(_ALLOW_KEYS)}; here {lacking[0]} is missing"
                )
                self._found.append(report(codes.BAD_ALLOWANCE, message, span))
                continue
            code = allowable(entry["code"], span)
            if isinstance(code, Diagnostic):
                self._found.append(code)
                continue
            root = self._root.absolute()
            yield ProjectAllowance(code.name, entry["path"], entry["reason"], root, span)

    def _unknown(
        self, table: Mapping[str, Any], known: Sequence[str], prefix: str, span: Span | None = None
    ) -> None:
        for key in table:
            if key not in known:
                message = f"the project file knows no '{prefix}{key}'"
                hint = did_you_mean(key, known, f"it knows {', '.join(known)}")
                self._say(codes.UNKNOWN_PROJECT_KEY, message, span or self._place(key), hint)

    def _wrong(self, key: str, what: str, hint: str = "") -> None:
        self._say(codes.BAD_PROJECT_VALUE, f"'{key}' {what}", self._place(key), hint)

    def _say(self, code: Code, message: str, span: Span, hint: str) -> None:
        self._found.append(report(code, message, span, hint))

    def _place(self, key: str) -> Span:
        """Return the span of a key, found by its text: TOML's reader gives no positions."""
        text = self._source.text
        start = 0
        if header := re.search(r"(?m)^\s*\[+\s*tool\s*\.\s*[\"']?deros", text):
            start = header.start()
        word = re.escape(key)
        pattern = re.compile(
            rf"(?m)^\s*(?:\[[^\n]*?\.\s*)?[\"']?({word})[\"']?\s*[=\].]|\b({word})\s*="
        )
        found = pattern.search(text, start)
        if found is None:
            return Span(self._source, start, start)
        group = 1 if found[1] is not None else 2
        return Span(self._source, found.start(group), found.end(group))

    def _entry(self, number: int) -> Span:
        """Return the span of an allowance."""
        headers = re.finditer(r"(?m)^\s*(\[\[[^\]\n]*\ballow\s*\]\])", self._source.text)
        header = next((each for n, each in enumerate(headers) if n == number), None)
        if header is None:
            place = self._place("allow")
            # Entries need different spans, even if all of them are in one list.
            return Span(self._source, place.start, place.end + number)
        return Span(self._source, header.start(1), header.end(1))


def _is_text(value: Any) -> bool:
    return isinstance(value, str) and bool(value.strip())


def _is_texts(value: Any) -> bool:
    return isinstance(value, list) and all(isinstance(each, str) and each for each in value)
