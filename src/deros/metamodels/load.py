"""Loading models: each file once per run, with everything that it imports."""

from __future__ import annotations

import os
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from deros import codes
from deros.diagnostics import Diagnostic, Related, SourceFile, Span, report
from deros.interfaces.files import real_path
from deros.metamodels.globbing import matching_files
from deros.metamodels.imports import find_files, listed_folders, shown_path
from deros.metamodels.languages import Language, entry_point, language_of, suffixes
from deros.metamodels.launch_files.library import LaunchFiles
from deros.metamodels.matching import DoesNotParse, Token
from deros.metamodels.parameter_files.library import ParameterFiles
from deros.metamodels.parsers import read_model
from deros.metamodels.reading import MAX_DEPTH, Unreadable, prepare, read, room_to_parse, too_deep
from deros.metamodels.scoping import FileIndex
from deros.models.node import NodeType
from deros.models.rules import Rules
from deros.models.system import Import, RulesReference, SafetyInstance, System


@dataclass(frozen=True, slots=True)
class LoadedFile:
    """One model file as it was loaded.

    Attributes:
        path: as the user named it, or as the import that led to it resolves.
        language: ``None`` when the suffix belongs to no language.
        source: ``None`` when the file could not be read.
        model: the part of it that parses; ``None`` when its head does not parse or the file could
            not be read.
        diagnostics: the faults in encoding, syntax and references of this file alone.
    """

    path: str
    language: Language | None
    source: SourceFile | None
    model: NodeType | System | Rules | None
    diagnostics: tuple[Diagnostic, ...]


@dataclass(frozen=True, slots=True)
class _Open:
    """A file that is being loaded, and the import statement that is being followed."""

    key: str
    path: str
    follows: Span


class Repository:
    """The models of one run; each file is read, parsed and converted once."""

    def __init__(self) -> None:
        self._files: dict[str, LoadedFile] = {}
        self._parts: set[str] = set()  # those of :meth:`load_part`
        self._open: list[_Open] = []
        self._users: dict[str, set[str]] = {}  # of each file, those that import or use it
        self._folders: dict[str, None] = {}
        self._unresolved: list[tuple[RulesReference, str]] = []
        self.parameter_files = ParameterFiles()
        """The parameter files that the systems name, once they have been looked at."""
        self.launch_files = LaunchFiles()
        """The launch files that the systems name, once they have been looked at."""

    @property
    def files(self) -> list[LoadedFile]:
        """Every file loaded so far: the requested ones and their imports, imports first."""
        return list(self._files.values())

    @property
    def diagnostics(self) -> list[Diagnostic]:
        """The findings of all files loaded so far."""
        return [each for loaded in self._files.values() for each in loaded.diagnostics]

    @property
    def folders(self) -> list[str]:
        """Every folder whose content decided what was loaded: those of globs in imports."""
        return list(self._folders)

    def listing(self, folder: Path, pattern: str) -> list[Path]:
        """Return the files of a folder that match, by name; the folder joins :attr:`folders`."""
        self._folders[shown_path(str(folder))] = None
        return sorted(map(Path, matching_files(str(folder), pattern)))

    def load(self, path: str | Path) -> LoadedFile:
        """Load the model in the file ``path`` and everything that it imports.

        A fault of the file is a diagnostic of the result, never an exception.
        """
        shown = str(path)
        key = _identity(shown)
        if key not in self._files:
            try:
                source = read(Path(path), shown, streams=False)
            except Unreadable as unreadable:
                found = (unreadable.diagnostic,)
                self._files[key] = LoadedFile(shown, language_of(shown), None, None, found)
            else:
                self._files[key] = self._convert(key, source)
        self._resolve_rules()
        return self._files[key]

    def load_text(self, path: str | Path, text: str) -> LoadedFile:
        """Load ``text`` as the content of the file ``path``, whatever the disk holds.

        It replaces what was loaded for ``path`` before; imports in it come from the disk as usual.
        """
        key = _identity(str(path))
        self._files.pop(key, None)
        self._files[key] = self._convert(key, SourceFile(str(path), text))
        self._resolve_rules()
        return self._files[key]

    def load_part(self, path: str | Path, source: SourceFile, language: Language) -> LoadedFile:
        """Load ``source``, which stands in another file, as the content of the file ``path``.

        Findings name the other file. Imports find it under ``path``, whatever the disk holds.
        """
        key = _identity(str(path))
        self._files.pop(key, None)
        self._parts.add(key)
        self._files[key] = self._convert(key, source, language)
        self._resolve_rules()
        return self._files[key]

    def forget(self, path: str | Path) -> None:
        """Forget the file ``path`` and all that rests on it: they are read anew when asked for."""
        stale = [_identity(str(path))]
        while stale:
            key = stale.pop()
            self._files.pop(key, None)
            stale += self._users.pop(key, ())

    def refer(self, reference: RulesReference, path: str, user: str) -> None:
        """Have ``reference`` resolved to the rules in the file ``path``, once that can be loaded.

        The rules use the system that refers to them, so that has to be loaded before; ``user`` is
        its identity.
        """
        self._users.setdefault(_identity(path), set()).add(user)
        self._unresolved.append((reference, path))

    def _resolve_rules(self) -> None:
        if self._open:
            return
        while self._unresolved:
            reference, path = self._unresolved.pop(0)
            model = self.load(path).model
            reference.rules = model if isinstance(model, Rules) else None

    def _convert(
        self, key: str, source: SourceFile, language: Language | None = None
    ) -> LoadedFile:
        language = language or language_of(source.path)
        if language is None:
            message = (
                f"'{source.path}' is not a model: its name ends in none of {', '.join(suffixes())}"
            )
            found = report(codes.UNKNOWN_LANGUAGE, message, Span(source, 0, 0))
            return LoadedFile(source.path, None, source, None, (found,))
        loading = Loading(self, key, source, language)
        try:
            with room_to_parse():
                model = entry_point(language.loader)(loading)
        except Unreadable as unreadable:
            return LoadedFile(source.path, language, source, None, (unreadable.diagnostic,))
        except _NoModel:
            model = None
        return LoadedFile(source.path, language, source, model, tuple(loading.diagnostics))

    def find(
        self, importer: str, pattern: str, span: Span, languages: Sequence[Language]
    ) -> tuple[str, ...] | Diagnostic:
        """Find the files that an import means; the folders of a glob join :attr:`folders`."""
        beside = os.path.normpath(Path(importer).parent / pattern)
        if self._parts and _identity(beside) in self._parts:
            return (shown_path(beside),)
        self._folders.update(dict.fromkeys(listed_folders(importer, pattern)))
        return find_files(importer, pattern, span, tuple(each.suffix for each in languages))

    def follow(self, importer: _Open, path: str) -> LoadedFile | Diagnostic:
        """Load the file ``path`` for an import; a cycle of imports is a diagnostic."""
        key = _identity(path)
        self._users.setdefault(key, set()).add(importer.key)
        chain = [*self._open, importer]
        keys = [each.key for each in chain]
        if key in keys:
            return _cycle(chain[keys.index(key) :])
        if len(chain) > MAX_DEPTH:
            return too_deep(importer.follows)
        self._open.append(importer)
        try:
            return self.load(path)
        finally:
            self._open.pop()


class Loading:
    """The loading of one file's text: what the converter of its language works with.

    Attributes:
        source: the file.
        diagnostics: the findings so far; the converter adds its own.
    """

    def __init__(
        self, repository: Repository, key: str, source: SourceFile, language: Language
    ) -> None:
        self._repository = repository
        self._key = key
        self._language = language
        self.source = source
        self.diagnostics: list[Diagnostic] = []

    def parse(self, before_references: Callable[[Any], None] | None = None) -> Any:
        """Return the textX model of the text, leaving out statements with syntax errors if need be.

        Args:
            before_references: called with the model before its references are resolved.

        Raises:
            _NoModel: not even the head of the file parses.
        """
        text = prepare(self.source)
        try:
            return read_model(self._language, text, before_references)
        except DoesNotParse:
            pass
        from deros.metamodels.recovery.recovery import recover

        recovered = recover(self.source, text, self._language)
        self.diagnostics += recovered.diagnostics
        if recovered.text is None:
            raise _NoModel
        return read_model(self._language, recovered.text, before_references)

    @property
    def parameter_files(self) -> ParameterFiles:
        """The parameter files of the run."""
        return self._repository.parameter_files

    @property
    def launch_files(self) -> LaunchFiles:
        """The launch files of the run."""
        return self._repository.launch_files

    def refer(self, statement: SafetyInstance, languages: Sequence[Language]) -> None:
        """Find the rules that a ``safety`` statement names; they are loaded later."""
        span = statement.path_span
        found = self._repository.find(self.source.path, statement.path, span, languages)
        if isinstance(found, tuple) and len(found) > 1:
            message = f"'{statement.path}' matches {len(found)} files"
            hint = "name the one file with the rules of the safety node"
            found = report(codes.UNKNOWN_IMPORT, message, span, hint)
        if isinstance(found, Diagnostic):
            self.diagnostics.append(found)
        else:
            self._repository.refer(statement.reference, found[0], self._key)

    def follow(self, statement: Any, index: FileIndex, languages: Sequence[Language]) -> Import:
        """Load the files of one ``import`` or ``use`` statement and index what they define."""
        token: Token = statement.path
        span = Span(self.source, token.start, token.end)
        pattern = str(token[1:-1])
        found = self._repository.find(self.source.path, pattern, span, languages)
        if isinstance(found, Diagnostic):
            self.diagnostics.append(found)
            index.complete = False
            found = ()
        importer = _Open(self._key, self.source.path, span)
        for path in found:
            loaded = self._repository.follow(importer, path)
            if isinstance(loaded, Diagnostic):
                self.diagnostics.append(loaded)
                index.complete = False
            elif isinstance(loaded.model, NodeType):
                index.add_node_type(loaded.model)
            elif isinstance(loaded.model, System):
                index.add_system(loaded.model)
            else:
                index.complete = False
        whole = Span(self.source, statement._tx_position, statement._tx_position_end)
        return Import(pattern, tuple(found), whole)


class _NoModel(Exception):  # noqa: N818 - the findings say what is wrong
    """The head of a file cannot be parsed."""


def _identity(path: str) -> str:
    """Return the resolved path, which is the same for all names of one file."""
    try:
        return real_path(path)
    except ValueError:  # a name with a NUL in it, which reading will report
        return path


def _cycle(chain: list[_Open]) -> Diagnostic:
    """Make the diagnostic of an import cycle."""
    names = " → ".join(f"'{each.path}'" for each in [*chain, chain[0]])
    *before, last = chain
    related = tuple(Related(each.follows, "imported from here") for each in before)
    message = f"import cycle: {names}"
    return report(codes.CYCLIC_IMPORT, message, last.follows, "", related)
