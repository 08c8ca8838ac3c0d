"""Running one mutant the whole way: load, check, generate, read back, simulate, decode.

Everything stays in this process and in memory, but for the models themselves, which imports look
for on the disk.
"""

from __future__ import annotations

import json
import random
import tempfile
from collections import Counter
from collections.abc import Iterator, Mapping, Sequence
from pathlib import Path, PurePosixPath
from typing import Any
from xml.etree import ElementTree

from deros.diagnostics import Diagnostic, SourceFile, has_errors
from deros.generators.api.protocol import Context, Files, GenerationError, OptionError
from deros.generators.api.registry import discover
from deros.generators.decoder.python.interface import Topic, render_decoders
from deros.generators.monitor.python.render import render_monitor
from deros.generators.monitor.python.run import GeneratedMonitor
from deros.interfaces.store import InterfaceStore
from deros.metamodels.load import LoadedFile, Repository
from deros.models.rules import Rules
from deros.pipeline.outcome import blocking_diagnostics
from deros.report.formats import render_json
from deros.rules.compiler.build import build
from deros.rules.engine.engine import Engine
from deros.rules.program.ir import Program
from deros.simulation.simulate import Monitor, event_record, simulate
from deros.simulation.trace import Trace, read_trace
from deros.validators.check import check, check_file
from tools.fuzzing import projects
from tools.fuzzing.mutants import MESSAGE, TRACE, Mutant
from tools.fuzzing.mutations import mutate_bytes, mutate_text
from tools.fuzzing.projects import Project

_MESSAGES = 8


class Wrong(AssertionError):  # noqa: N818 - findings are shown with this name
    """Something came out that must not: no exception of deros, but not what it promises either."""


def sound_rules(found: Sequence[Project]) -> dict[str, tuple[str, ...]]:
    """Return the files of rules of some projects that build, by the project's name."""
    with tempfile.TemporaryDirectory(prefix="deros-fuzz-") as folder:
        runner = Runner(Path(folder))
        return {
            each.name: tuple(path for path in each.models if runner.builds(each, path))
            for each in found
        }


class Runner:
    """Runs mutants one after another in a folder of its own.

    Attributes:
        ends: how the mutants ended, counted: with findings, generated, simulated and so on.
    """

    def __init__(self, folder: Path) -> None:
        """Use ``folder``, which belongs to this runner alone."""
        self._folder = folder
        self._present: dict[str, dict[str, bytes]] = {}
        self._programs: dict[tuple[str, str], _Sound | None] = {}
        self.ends: Counter[str] = Counter()

    def builds(self, project: Project, path: str) -> bool:
        """Return whether a model of a project is one of rules without errors."""
        return (
            path.endswith(".deros")
            and self._sound(Mutant("trace", project.name, project.files, path)) is not None
        )

    def findings(self, mutant: Mutant) -> list[Diagnostic]:
        """Return what is found when the models of a mutant are checked."""
        return self._loaded(mutant)[2]

    def run(self, mutant: Mutant) -> Mutant:
        """Run one mutant; return it with the trace or message that was drawn for it.

        Raises:
            Exception: whatever deros raises and should not, or :class:`Wrong`.
        """
        for completed in self.stages(mutant):
            mutant = completed
        return mutant

    def stages(self, mutant: Mutant) -> Iterator[Mutant]:
        """Yield the mutant when it is complete, and run it after that.

        A mutant of a trace or a message is drawn here, because its program has to be known.
        """
        if mutant.kind in ("trace", "message"):
            sound = self._sound(mutant)
            if sound is None:
                self.ends["no program"] += 1
                return
            mutant = _drawn(mutant, sound)
            yield mutant
            if mutant.kind == "trace":
                self._trace(mutant, sound)
            else:
                self._message(mutant, sound)
            return
        yield mutant
        self._model(mutant)

    def _model(self, mutant: Mutant) -> None:
        context, loaded, findings = self._loaded(mutant)
        _check_findings(findings)
        if has_errors(blocking_diagnostics(findings, loaded.path)) or loaded.model is None:
            self.ends["with errors"] += 1
            return
        for generator in discover().generators:
            if loaded.language is None or generator.language != loaded.language.name:
                continue
            try:
                files = generator(loaded.model, context)
            except GenerationError as error:
                _check_findings(error.diagnostics)
                self.ends["refused by a target"] += 1
            except OptionError:  # no value is given to an argument that has no default
                self.ends["without an option"] += 1
            else:
                _check_files(files)
        self.ends["generated"] += 1
        if isinstance(loaded.model, Rules):
            program = build(loaded.model, context.store).program
            if program is not None:
                chance = random.Random(mutant.number)
                text = projects.trace(program, _MESSAGES, chance)
                trace = read_trace(SourceFile(TRACE, text), program, context.store)
                self._simulate(trace, program, render_monitor(program))

    def _simulate(self, trace: Trace, program: Program, generated: Mapping[str, str]) -> None:
        _check_findings(trace.diagnostics)
        monitors: list[Monitor] = [Engine(program), GeneratedMonitor(program, texts=generated)]
        # One line of text for each event, so that NaN equals itself.
        played = [
            [json.dumps(event_record(event)) for event in simulate(monitor, trace.messages, 10**11)]
            for monitor in monitors
        ]
        if played[0] != played[1]:
            raise Wrong("the generated monitor and the reference differ")
        self.ends["simulated"] += 1

    def _trace(self, mutant: Mutant, sound: _Sound) -> None:
        text = mutant.files[TRACE].decode(errors="replace")
        trace = read_trace(SourceFile(TRACE, text), sound.program, sound.store)
        self._simulate(trace, sound.program, sound.monitor)

    def _message(self, mutant: Mutant, sound: _Sound) -> None:
        for decode, errors in sound.decoders:
            refused = _refuses(decode, errors, mutant.files[MESSAGE])
            self.ends["refused by a decoder" if refused else "decoded"] += 1

    # Models on the disk ---------------------------------------------------------------------------

    def _loaded(self, mutant: Mutant) -> tuple[Context, LoadedFile, list[Diagnostic]]:
        folder = self._written(mutant)
        definitions = [folder / projects.INTERFACES] if _has_definitions(mutant) else []
        context = Context(InterfaceStore(definitions, ()), Repository(), check_file)
        loaded = context.repository.load(folder / mutant.entry)
        return context, loaded, check([loaded], context.repository, context.store)

    def _written(self, mutant: Mutant) -> Path:
        """Bring the files to the disk, touching only those that differ from what is there."""
        folder = self._folder / mutant.project
        present = self._present.setdefault(mutant.project, {})
        for path in present.keys() - mutant.files.keys():
            (folder / path).unlink()
            del present[path]
        for path, content in mutant.files.items():
            if present.get(path) is not content and present.get(path) != content:
                target = folder / path
                target.parent.mkdir(parents=True, exist_ok=True)
                target.write_bytes(content)
            present[path] = content
        return folder

    def _sound(self, mutant: Mutant) -> _Sound | None:
        """Return the program of a mutant's rules, which were not mutated, with its decoders."""
        key = mutant.project, mutant.entry
        if key not in self._programs:
            models = {path: mutant.files[path] for path in mutant.files if path not in _DRAWN}
            context, loaded, _ = self._loaded(Mutant("model", mutant.project, models, mutant.entry))
            program = None
            if isinstance(loaded.model, Rules):
                program = build(loaded.model, context.store).program
            self._programs[key] = None if program is None else _Sound(program, context.store)
        return self._programs[key]


def _refuses(decode: Any, errors: tuple[type[Exception], ...], data: bytes) -> bool:
    try:
        decode(data)
    except errors:
        return True
    return False


_DRAWN = (TRACE, MESSAGE)


def _has_definitions(mutant: Mutant) -> bool:
    return any(path.startswith(f"{projects.INTERFACES}/") for path in mutant.files)


class _Sound:
    """A program without errors, the definitions it needs, and its decoders."""

    def __init__(self, program: Program, store: InterfaceStore) -> None:
        self.program = program
        self.store = store
        self.monitor = render_monitor(program)
        self.read = list(projects.readable(program))
        self.decoders: list[tuple[Any, tuple[type[Exception], ...]]] = []
        for number, (_, kind, paths) in enumerate(self.read):
            topic = Topic(f"topic_{number}", kind, paths)
            module: dict[str, Any] = {}
            exec(compile(render_decoders([topic], store), "decoders.py", "exec"), module)
            self.decoders.append((module[topic.function], module["DECODING_ERRORS"]))


def _drawn(mutant: Mutant, sound: _Sound) -> Mutant:
    """Return the mutant with a trace or a message, unless it has one."""
    path = TRACE if mutant.kind == "trace" else MESSAGE
    if path in mutant.files:
        return mutant
    chance = random.Random(f"{mutant.project}:{mutant.number}")
    if mutant.kind == "trace":
        text = projects.trace(sound.program, chance.randint(1, _MESSAGES), chance)
        content = mutate_text(text, (), chance).encode(errors="replace")
    elif sound.read:
        _, kind, _ = chance.choice(sound.read)
        content = mutate_bytes(projects.message(sound.store, kind, chance), chance)
    else:
        content = chance.randbytes(chance.randint(0, 64))
    return mutant.with_file(path, content)


# What must hold of whatever comes out -------------------------------------------------------------


def _check_findings(findings: list[Diagnostic] | tuple[Diagnostic, ...]) -> None:
    """Hold what is true of every finding: words, and a place that lies in its text."""
    for found in findings:
        if not found.message:
            raise Wrong(f"{found.code.name} says nothing")
        texts = found.message, found.hint, *(each.message for each in found.related)
        if max(map(len, texts)) > _LONGEST_MESSAGE:
            raise Wrong(f"{found.code.name} says more than anybody reads")
        for span in (found.span, *(each.span for each in found.related)):
            if not 0 <= span.start <= span.end <= len(span.source.text):
                raise Wrong(f"{found.code.name} lies outside its file")
            if (span.line, span.column) > (span.end_line, span.end_column):
                raise Wrong(f"{found.code.name} ends before it begins")
    render_json(findings).encode()


_LONGEST_MESSAGE = 2000


def _check_files(files: Files) -> None:
    """Hold what is true of all generated files: they can be written, and read by their readers."""
    for path, file in files.items():
        try:
            file.text.encode()
        except UnicodeEncodeError as error:
            raise Wrong(f"{_shape(path)} holds half a character") from error
        if any(len(part.encode()) > _LONGEST_NAME for part in PurePosixPath(path).parts):
            raise Wrong(f"the path of a generated {_shape(path)} is longer than file systems take")
        if any(ord(character) < 32 and character != "\n" for character in file.text):
            raise Wrong(f"{_shape(path)} holds a control character")
        if path.endswith(".py"):
            try:
                compile(file.text, path, "exec", dont_inherit=True)
            except SyntaxError as error:
                raise Wrong(f"{_shape(path)} is not Python: {error.msg}") from error
        elif path.endswith(".xml"):
            ElementTree.fromstring(file.text)
        elif path.endswith(".rnd"):
            _check_description(path, file.text)


_LONGEST_NAME = 255


def _shape(path: str) -> str:
    """Return what kind of file a path is, without the names that vary from mutant to mutant."""
    name = PurePosixPath(path).name
    return name if len(name) < 40 and name.isascii() else f"*{PurePosixPath(path).suffix}"


def _check_description(path: str, text: str) -> None:
    loaded = Repository().load_text(PurePosixPath(path).name, text)
    if loaded.model is None or any(each.is_error for each in loaded.diagnostics):
        raise Wrong("a generated node description is not one")
    wrong = [
        each
        for each in check([loaded], Repository(), InterfaceStore((), ()))
        if each.is_error and each.code.name not in _DEPENDS_ON_INTERFACES
    ]
    if wrong:
        raise Wrong(f"a generated node description has the error {wrong[0].code.name}")


_DEPENDS_ON_INTERFACES = ("DRS101", "DRS102")
