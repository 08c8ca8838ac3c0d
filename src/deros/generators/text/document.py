"""A document printer: text with places where lines may break, laid out within a width.

All emitted Python, C and C++ that can be too long for a line goes through it. A document is a
string, or one of the combinators below:

=======================  ======================================================================
``LINE``                 a blank, or a line break where its group is broken
``SOFTLINE``             nothing, or a line break where its group is broken
``HARDLINE``             a line break; every group around it is broken
``concat(a, b, …)``      one document after the other
``group(a, b, …)``       on one line if that fits, otherwise broken at all of its own lines
``nest(2, a, b, …)``     lines that begin within it are indented by so much more
``align(a, b, …)``       lines that begin within it are indented to the column where it starts
``fill(items)``          as many items on each line as fit
``if_broken(a, b)``      ``a`` where the group around it is broken, otherwise ``b``
``breakable(text, f)``   a text that, where it is too long, is replaced by the document ``f`` makes
=======================  ======================================================================

A group fits if its text, and the text behind it up to the next possible line break, ends within
the width. The width is counted in characters, as flake8 and cpplint count it for ASCII text.
Rendering is pure, does not recurse, and looks at most one line ahead at each group, so the time is
linear in the size of the document.

Sources: P. Wadler, "A prettier printer" (2003), for ``group`` and ``nest``; D. Leijen, PPrint, for
``align`` and ``fill``; C. Lindig, "Strictly pretty" (2000), for the strict algorithm. No package
from PyPI is used, since none has all of it: ``wadler_lindig`` (maintained, typed) has neither
``fill``, ``align`` nor ``if_broken`` and does not count the text behind a group, which for code is
the closing bracket; ``prettyprinter`` and ``pprinter`` are no longer maintained.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable

_ENDLESS = 1 << 60
"""The flat width of a document that cannot be on one line."""


class _Node:
    """A document that is not a plain string.

    Attributes:
        flat: its width on one line.
        lead: the width of its text up to its first possible line break, or of all its text.
        breaks: whether it has a possible line break.
    """

    __slots__ = ("breaks", "flat", "lead")

    flat: int
    lead: int
    breaks: bool


Document = str | _Node
"""A string without line breaks, or what a combinator of this module returns."""


class Line(_Node):
    """A possible line break.

    Attributes:
        text: stands there if the line is not broken; ``None``: it is always broken.
        before: stands at the end of the line if it is broken.
        after: stands at the start of the next line, behind the indentation, if it is broken.
    """

    __slots__ = ("after", "before", "text")

    def __init__(self, text: str | None, before: str = "", after: str = "") -> None:
        """Declare a line break, and the texts around it."""
        self.text = text
        self.before = before
        self.after = after
        self.flat = _ENDLESS if text is None else len(text)
        self.lead = len(before)
        self.breaks = True


LINE = Line(" ")
SOFTLINE = Line("")
HARDLINE = Line(None)


class _Concat(_Node):
    __slots__ = ("parts",)

    def __init__(self, parts: tuple[Document, ...]) -> None:
        self.parts = parts
        self.flat = self.lead = 0
        self.breaks = False
        for part in parts:
            if isinstance(part, str):
                size = _measured(part)
                self.flat += size
                self.lead += 0 if self.breaks else size
            else:
                self.flat += part.flat
                self.lead += 0 if self.breaks else part.lead
                self.breaks = self.breaks or part.breaks


class _Around(_Node):
    """A document around one other, of the same size."""

    __slots__ = ("content",)

    def __init__(self, content: Document) -> None:
        self.content = content
        if isinstance(content, str):
            self.flat = self.lead = _measured(content)
            self.breaks = False
        else:
            self.flat, self.lead, self.breaks = content.flat, content.lead, content.breaks


class _Group(_Around):
    __slots__ = ()


class _Align(_Around):
    __slots__ = ()


class _Nest(_Around):
    __slots__ = ("margin",)

    def __init__(self, margin: str, content: Document) -> None:
        super().__init__(content)
        self.margin = margin


class _IfBroken(_Around):
    __slots__ = ("otherwise",)

    def __init__(self, content: Document, otherwise: Document) -> None:
        super().__init__(content)
        self.otherwise = otherwise
        self.flat = _width(otherwise)


class _Breakable(_Node):
    __slots__ = ("broken", "text")

    def __init__(self, text: str, broken: Callable[[int], Document]) -> None:
        self.text = text
        self.broken = broken
        self.flat = self.lead = _measured(text)
        self.breaks = False


class _Fill(_Node):
    """The items of a fill from number ``start`` on, and the line break in front of that one."""

    __slots__ = ("items", "line", "start")

    def __init__(self, items: tuple[Document, ...], line: Line, start: int, flat: int) -> None:
        self.items = items
        self.line = line
        self.start = start
        self.flat = flat
        if start:
            self.lead, self.breaks = line.lead, True
        else:
            several = len(items) > 1
            self.breaks = several or _breaks(items[0])
            self.lead = _lead(items[0])
            self.lead += line.lead if several and not _breaks(items[0]) else 0


def _measured(text: str) -> int:
    if "\n" in text:
        raise ValueError(f"a text in a document has a line break: {text!r}")
    return len(text)


def _width(document: Document) -> int:
    return _measured(document) if isinstance(document, str) else document.flat


def _lead(document: Document) -> int:
    return len(document) if isinstance(document, str) else document.lead


def _breaks(document: Document) -> bool:
    return not isinstance(document, str) and document.breaks


# Combinators --------------------------------------------------------------------------------------


def concat(*parts: Document) -> Document:
    """Return documents one after the other."""
    return parts[0] if len(parts) == 1 else _Concat(parts)


def group(*parts: Document) -> Document:
    """Return a document that is on one line if it fits, otherwise broken at its own lines."""
    return _Group(concat(*parts))


def nest(by: int | str, *parts: Document) -> Document:
    """Return a document whose further lines are indented by so many blanks, or by a text."""
    return _Nest(" " * by if isinstance(by, int) else by, concat(*parts))


def align(*parts: Document) -> Document:
    """Return a document whose further lines start in the column in which it starts."""
    return _Align(concat(*parts))


def join(separator: Document, items: Iterable[Document]) -> Document:
    """Return the items with a document between each two."""
    parts: list[Document] = []
    for item in items:
        parts += [separator, item] if parts else [item]
    return concat(*parts)


def comma_separated(items: Iterable[Document]) -> Document:
    """Return the items with a comma and a possible line break between each two."""
    return join(concat(",", LINE), items)


def fill(items: Iterable[Document], line: Line = LINE) -> Document:
    """Return the items with as many on each line as fit, and ``line`` between each two."""
    listed = tuple(items)
    if not listed:
        return ""
    return _Fill(listed, line, 0, sum(map(_width, listed)) + line.flat * (len(listed) - 1))


def if_broken(broken: Document, flat: Document = "") -> Document:
    """Return a document for where the group around it is broken, and one for where it is not."""
    return _IfBroken(broken, flat)


def breakable(text: str, broken: Callable[[int], Document]) -> Document:
    """Return a text that is replaced if it does not fit.

    Args:
        text: the text on one line.
        broken: returns the document for the text in several lines; it is given the indentation.
    """
    return _Breakable(text, broken)


# Rendering ----------------------------------------------------------------------------------------


def flatten(document: Document) -> str:
    """Return a document on one line.

    Raises:
        ValueError: if it has a line break that is always broken.
    """
    if _width(document) >= _ENDLESS:
        raise ValueError("a document with a hard line break has no form on one line")
    return "".join(_flat_texts(document))


def _flat_texts(document: Document) -> list[str]:
    texts: list[str] = []
    stack = [document]
    while stack:
        node = stack.pop()
        if isinstance(node, str):
            texts.append(node)
        elif isinstance(node, _Concat):
            stack.extend(reversed(node.parts))
        elif isinstance(node, _IfBroken):
            stack.append(node.otherwise)
        elif isinstance(node, _Around):
            stack.append(node.content)
        elif isinstance(node, Line):
            texts.append(node.text or "")
        elif isinstance(node, _Breakable):
            texts.append(node.text)
        elif isinstance(node, _Fill):
            for item in reversed(node.items[node.start :]):
                stack += [item, node.line]
            if not node.start:
                stack.pop()
    return texts


def render(document: Document, width: int, indent: int = 0, column: int | None = None) -> str:
    """Return a document as text, laid out in lines of at most ``width`` characters if possible.

    Args:
        document: what to lay out.
        width: the length that no line should exceed.
        indent: the blanks in front of every line but the first.
        column: where the first line starts; what stands there is not part of the text. By default
            ``indent``.
    """
    printer = _Printer(width, indent if column is None else column)
    printer.push(" " * indent, document)
    return printer.run()


def render_lines(document: Document, width: int, indent: int = 0) -> list[str]:
    """Return the lines of a document, all of them behind ``indent`` blanks."""
    return (" " * indent + render(document, width, indent)).split("\n")


class _Printer:
    """Lays out one document.

    Attributes:
        column: where the next text goes.
        lines: the complete lines.
        texts: those of the present line.
        stack: what is still to be printed, the next one last; none of it is on one line for sure.
    """

    def __init__(self, width: int, column: int) -> None:
        self.width = width
        self.column = column
        self.lines: list[str] = []
        self.texts: list[str] = []
        self.stack: list[tuple[str, Document]] = []

    def push(self, margin: str, document: Document) -> None:
        # An empty document is left out, so that looking ahead takes no more steps than columns.
        if document if isinstance(document, str) else document.flat or document.breaks:
            self.stack.append((margin, document))
        elif isinstance(document, _IfBroken):
            self.push(margin, document.content)

    def run(self) -> str:
        stack = self.stack
        while stack:
            margin, node = stack.pop()
            if isinstance(node, str):
                self.texts.append(node)
                self.column += len(node)
            elif isinstance(node, _Concat):
                for part in reversed(node.parts):
                    self.push(margin, part)
            elif isinstance(node, Line):
                self.break_line(margin, node)
            elif isinstance(node, _Fill):
                self.fill(margin, node)
            elif isinstance(node, _Breakable):
                if self.fits(node.flat):
                    self.put_flat(node)
                else:
                    self.push(margin, node.broken(len(margin)))
            elif isinstance(node, _Group) and self.fits(node.flat):
                self.put_flat(node)
            elif isinstance(node, _Around):
                if isinstance(node, _Nest):
                    margin += node.margin
                elif isinstance(node, _Align):
                    margin = margin.ljust(self.column)
                self.push(margin, node.content)
        return "\n".join([*self.lines, "".join(self.texts)])

    def break_line(self, margin: str, line: Line) -> None:
        self.texts.append(line.before)
        self.lines.append("".join(self.texts).rstrip(" "))
        start = margin + line.after
        self.texts = [start]
        self.column = len(start)

    def put_flat(self, document: Document) -> None:
        if isinstance(document, str):
            self.texts.append(document)
            self.column += len(document)
        else:
            self.texts += _flat_texts(document)
            self.column += document.flat

    def fits(self, size: int) -> bool:
        """Tell whether so much fits on the line, with the text behind it up to a line break."""
        room = self.width - self.column - size
        for _, node in reversed(self.stack):
            if room < 0:
                break
            if isinstance(node, str):
                room -= len(node)
            else:
                room -= node.lead
                if node.breaks:
                    break
        return room >= 0

    def fill(self, margin: str, node: _Fill) -> None:
        """Print one item, or those up to the next broken line, and leave the others for later."""
        items, line = node.items, node.line
        between = line.text or ""
        last = len(items) - 1
        for number in range(node.start, len(items)):
            item = items[number]
            size = len(item) if isinstance(item, str) else item.flat
            size += line.flat if number else 0
            if number < last:
                has_room = self.column + size + line.lead <= self.width
            else:
                has_room = self.fits(size)
            if not has_room:
                if number:
                    self.break_line(margin, line)
                if number < last:
                    self.push(margin, _Fill(items, line, number + 1, 0))
                self.push(margin, _Group(item))
                return
            if number:
                self.put_flat(between)
            self.put_flat(item)
