"""An editor without a screen: it opens files, types, and asks the language server."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from lsprotocol import types
from pytest_lsp import LanguageClient

from deros.lsp.features.symbols import LEGEND

_LANGUAGES = {".rnd": "rosnode", ".system": "rossystem", ".deros": "deros"}


@dataclass
class Document:
    """One open file: its text as the editor has it, which need not be saved."""

    editor: Editor
    path: Path
    text: str
    version: int = 1

    @property
    def client(self) -> LanguageClient:
        """What talks to the server."""
        return self.editor.client

    @property
    def uri(self) -> str:
        """The URI of the file."""
        return self.path.as_uri()

    @property
    def identifier(self) -> types.TextDocumentIdentifier:
        """How requests name the file."""
        return types.TextDocumentIdentifier(self.uri)

    def at(self, part: str, inside: str = "", after: int = 0) -> types.Position:
        """Return the position of a part of the text, or of a word inside of its first place."""
        offset = self.text.index(part, after)
        if inside:
            offset += part.index(inside)
        line = self.text.count("\n", 0, offset)
        return types.Position(line, offset - (self.text.rfind("\n", 0, offset) + 1))

    def change(self, text: str) -> None:
        """Replace the text."""
        self.text, self.version = text, self.version + 1
        self.client.text_document_did_change(
            types.DidChangeTextDocumentParams(
                types.VersionedTextDocumentIdentifier(version=self.version, uri=self.uri),
                [types.TextDocumentContentChangeWholeDocument(text)],
            )
        )

    def replace(self, old: str, new: str) -> None:
        """Replace one part of the text."""
        assert self.text.count(old) == 1, old
        self.change(self.text.replace(old, new))

    async def messages(self) -> list[str]:
        """Return the findings of the present text, once they are there: code and message each."""
        # A question waits for the analysis of the present text, and so for its findings.
        await self.client.text_document_document_symbol_async(
            types.DocumentSymbolParams(self.identifier)
        )
        return [
            f"{each.code}: {each.message}" for each in self.client.diagnostics.get(self.uri, ())
        ]

    async def hover(self, at: types.Position) -> str:
        """Return what the editor shows of a word."""
        found = await self.client.text_document_hover_async(types.HoverParams(self.identifier, at))
        if found is None:
            return ""
        assert isinstance(found.contents, types.MarkupContent)
        return found.contents.value

    async def definition(self, at: types.Position) -> list[str]:
        """Return where a word is declared: ``file:line:column`` each, from 1."""
        found = await self.client.text_document_definition_async(
            types.DefinitionParams(self.identifier, at)
        )
        places = found if isinstance(found, Sequence) else ()
        return [place(each) for each in places if isinstance(each, types.Location)]

    async def rename(self, at: types.Position, name: str) -> None:
        """Rename a thing, and take over the edits in all open files.

        Raises:
            JsonRpcException: the server refuses, and says why.
        """
        edit = await self.client.text_document_rename_async(
            types.RenameParams(self.identifier, at, name)
        )
        assert edit is not None
        self.editor.apply(edit)

    async def format(self) -> None:
        """Have the text laid out, and take over the edits."""
        options = types.FormattingOptions(tab_size=8, insert_spaces=False)
        edits = await self.client.text_document_formatting_async(
            types.DocumentFormattingParams(self.identifier, options)
        )
        self.editor.apply(types.WorkspaceEdit({self.uri: list(edits or ())}))

    async def apply_fix(self, at: types.Position) -> list[str]:
        """Take over the first quick fix at a place; return the titles of all."""
        found = await self.client.text_document_code_action_async(
            types.CodeActionParams(
                self.identifier, types.Range(at, at), types.CodeActionContext(diagnostics=[])
            )
        )
        actions = [each for each in found or () if isinstance(each, types.CodeAction)]
        assert actions[0].edit is not None
        self.editor.apply(actions[0].edit)
        return [each.title for each in actions]

    async def complete(self, before: str, written: str = "") -> dict[str, str]:
        """Return what is offered behind a part of the text, with the detail of each.

        Args:
            before: the part, which stands there once; it is the last one that is unchanged.
            written: what is typed behind it, in place of the rest of the line.
        """
        assert self.text.count(before) == 1, before
        offset = self.text.index(before) + len(before)
        if written:
            end = self.text.index("\n", offset)
            self.change(self.text[:offset] + written + self.text[end:])
            offset += len(written)
        line = self.text.count("\n", 0, offset)
        at = types.Position(line, offset - (self.text.rfind("\n", 0, offset) + 1))
        found = await self.client.text_document_completion_async(
            types.CompletionParams(self.identifier, at)
        )
        items = found.items if isinstance(found, types.CompletionList) else found or ()
        return {each.label: each.detail or "" for each in items}

    async def hints(self) -> list[str]:
        """Return the inlay hints: ``line:column text`` each, from 1."""
        whole = types.Range(types.Position(0, 0), types.Position(self.text.count("\n") + 1, 0))
        found = await self.client.text_document_inlay_hint_async(
            types.InlayHintParams(self.identifier, whole)
        )
        return [
            f"{each.position.line + 1}:{each.position.character + 1} {each.label}"
            for each in found or ()
        ]

    async def outline(self) -> list[str]:
        """Return the names of the outline, indented by a blank for each level."""
        found = await self.client.text_document_document_symbol_async(
            types.DocumentSymbolParams(self.identifier)
        )
        return list(_indented(found or (), ""))

    async def colours(self) -> list[tuple[str, str, list[str]]]:
        """Return the words with a colour: text, type and modifiers each."""
        found = await self.client.text_document_semantic_tokens_full_async(
            types.SemanticTokensParams(self.identifier)
        )
        lines, words = self.text.split("\n"), []
        line = column = 0
        data = [] if found is None else found.data
        for down, right, length, kind, bits in zip(*[iter(data)] * 5, strict=True):
            line, column = line + down, right + (column if not down else 0)
            named = [name for n, name in enumerate(LEGEND.token_modifiers) if bits >> n & 1]
            words.append((lines[line][column : column + length], LEGEND.token_types[kind], named))
        return words

    async def lenses(self) -> list[str]:
        """Return the commands that the lenses run, without the name of the program."""
        found = await self.client.text_document_code_lens_async(
            types.CodeLensParams(self.identifier)
        )
        commands = [each.command for each in found or ()]
        return [" ".join(map(str, each.arguments or ())) for each in commands if each is not None]

    async def references(self, at: types.Position) -> list[str]:
        """Return where a thing is named: ``file:line:column`` each, from 1."""
        context = types.ReferenceContext(include_declaration=True)
        found = await self.client.text_document_references_async(
            types.ReferenceParams(context, self.identifier, at)
        )
        return [place(each) for each in found or ()]


@dataclass
class Editor:
    """An editor with some open files in a folder."""

    client: LanguageClient
    folder: Path
    documents: dict[str, Document] = field(default_factory=dict)

    def write(self, **files: str) -> None:
        """Save files that are not open; of a name, ``_`` before the suffix is a dot."""
        for name, text in files.items():
            stem, _, suffix = name.rpartition("_")
            (self.folder / f"{stem}.{suffix}").write_text(text, encoding="utf-8")

    def open(self, name: str, text: str | None = None) -> Document:
        """Open a file, which need not be saved yet."""
        path = self.folder / name
        text = path.read_text(encoding="utf-8") if text is None else text
        self.client.text_document_did_open(
            types.DidOpenTextDocumentParams(
                types.TextDocumentItem(
                    path.as_uri(), _LANGUAGES.get(path.suffix, "plaintext"), 1, text
                )
            )
        )
        self.documents[name] = Document(self, path, text)
        return self.documents[name]

    def close(self, name: str) -> None:
        """Close a file without saving it."""
        document = self.documents.pop(name)
        self.client.text_document_did_close(types.DidCloseTextDocumentParams(document.identifier))

    def apply(self, edit: types.WorkspaceEdit) -> None:
        """Take over edits, all of which are in open files."""
        by_uri = {each.uri: each for each in self.documents.values()}
        for uri, edits in (edit.changes or {}).items():
            document = by_uri[uri]
            text = document.text
            starts = [0, *(n + 1 for n, c in enumerate(text) if c == "\n")]
            last_first = sorted(
                edits, key=lambda e: (e.range.start.line, e.range.start.character), reverse=True
            )
            for each in last_first:
                start = starts[each.range.start.line] + each.range.start.character
                end = starts[each.range.end.line] + each.range.end.character
                text = text[:start] + each.new_text + text[end:]
            document.change(text)


def place(location: types.Location) -> str:
    """Return a location as ``file:line:column``, from 1."""
    start = location.range.start
    name = location.uri.rpartition("/")[2]
    return f"{name}:{start.line + 1}:{start.character + 1}"


def _indented(symbols: Iterable[Any], indent: str) -> Iterator[str]:
    for each in symbols:
        yield indent + each.name
        yield from _indented(each.children or (), f"{indent} ")
