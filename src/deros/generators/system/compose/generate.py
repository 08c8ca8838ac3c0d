"""A compose file for each host, for certain values of the arguments.

Sources: https://github.com/compose-spec/compose-spec, "Services top-level elements", "Configs
top-level elements", "Interpolation".
"""

from __future__ import annotations

import posixpath
from collections.abc import Iterator, Sequence

from deros import codes
from deros.diagnostics import Diagnostic, report
from deros.generators.api.protocol import (
    Context,
    File,
    Files,
    GenerationError,
    Options,
)
from deros.generators.system.compose.services import Config, Service, own_file, service
from deros.generators.system.compose.spelling import block, literal, quoted
from deros.generators.system.files import file_view
from deros.generators.system.script.generate import table
from deros.generators.system.script.standalone.node import Row
from deros.generators.system.systemd.generate import (
    Holder,
    activated_by,
    assignments,
    faults_of,
    launched,
    setup_file,
    with_values,
)
from deros.generators.system.view import SystemView, system_view
from deros.generators.text.identifiers import Emitted, check_collisions
from deros.generators.text.templates import environment
from deros.models.parameter_files import Document, ParameterFile
from deros.models.system import System
from deros.systems.flat import FlatLaunch, FlatNode, FlatProcess
from deros.systems.flatten import flatten
from deros.systems.running.monitors import is_load_monitor
from deros.systems.running.placement import EVERYWHERE, HOST, placed

COMPOSE = Holder(
    "compose files",
    "a service of compose",
    "service",
    "compose starts all services together, and stops each on its own",
    "where it leads is a matter of the image",
)
_Program = FlatNode | FlatProcess


def generate(model: System, context: Context, options: Options) -> Files:  # noqa: ARG001
    """Return a compose file, for each host if there are any.

    Raises:
        GenerationError: if compose cannot do what the system says; each of its reasons is named.
        OptionError: if a value of an argument, the image or the setup file cannot be used.
    """
    setup = setup_file(options)
    words = assignments(options.get("arguments", ""))
    image = options.get("image")
    chosen = [word.partition(":=")[2] for word in words if word.startswith(f"{HOST}:=")]
    if chosen or not model.hosts:
        host = "" if chosen in ([], [EVERYWHERE]) else chosen[0]
        parts = [(host, _Part(model, words, setup))]
    else:
        names = [host.name for host in model.hosts]
        parts = [(name, _Part(model, [f"{HOST}:={name}", *words], setup)) for name in names]
    return {part.path(name): part.file(name, image) for name, part in parts}


class _Part:
    """What runs on one computer."""

    def __init__(self, model: System, words: list[str], setup: str) -> None:
        system = with_values(placed(model), words, COMPOSE)
        self._system = system
        self._flat = flatten(system)
        if self._flat.launches:
            raise GenerationError([launched(each, COMPOSE) for each in self._flat.launches])
        programs = [each for each in self._flat.programs if not isinstance(each, FlatLaunch)]
        faults = [fault for each in programs for fault in _faults(each)]
        if faults:
            raise GenerationError(faults)
        self._view = system_view(system)
        check_collisions(_emitted(programs), "the services")
        self._configs: dict[str, Config] = {}
        rows = table(self._view)
        descriptions = [each.description for each in self._view.programs]
        self.services = tuple(
            self._service(*each, setup) for each in zip(programs, rows, descriptions, strict=True)
        )

    def _service(self, program: _Program, row: Row, description: str, setup: str) -> Service:
        name = _name(program)
        files = [self._config(each) for each in program.files]
        own = own_file(row, name)
        for each in (*files, *([own] if own is not None else [])):
            self._configs.setdefault(each.name, each)
        return service(
            row,
            name,
            description,
            [_name(each) for each in activated_by(program, self._flat)],
            setup,
            files,
            own,
        )

    def _config(self, file: ParameterFile) -> Config:
        found = file.load()
        assert isinstance(found, Document)  # else it is a fault
        path = file_view(file, self._system, lambda text: text).path
        assert isinstance(path, str)
        known = Config.of_file(path, found.source.text)
        other = self._configs.setdefault(known.name, known)
        if other == known:
            return known
        raise GenerationError(
            [
                report(
                    codes.UNSUPPORTED_BY_TARGET,
                    f"'{file.path}' and another file would both be the config '{known.name}'",
                    file.path_span,
                    "rename one of the files",
                )
            ]
        )

    def path(self, host: str) -> str:
        """Return the path of the file."""
        return ".".join([self._view.stem, *([host] if host else []), "compose.yaml"])

    def file(self, host: str, image: str | None) -> File:
        """Return the file for a host, or for all of the system, and an image."""
        made = environment("deros.generators.system.compose")
        made.filters["quoted"], made.filters["literal"] = quoted, literal
        made.filters["block"] = block
        text = made.get_template("compose.yaml.j2").render(
            view=self._view,
            host=host,
            project="-".join([self._view.stem, *([host.lower()] if host else [])]),
            image=_variable(self._view) if image is None else quoted(image),
            services=self.services,
            configs=sorted(self._configs.values(), key=lambda each: each.name),
        )
        return File(text)


def _variable(view: SystemView) -> str:
    """Return an image that whoever starts the system has to name."""
    name = f"{view.stem.upper()}_IMAGE"
    return f"${{{name}:?the image that has the packages of {view.name}}}"


def _name(program: _Program) -> str:
    return program.full_name.removeprefix("/").replace("/", "-")


def _emitted(programs: Sequence[_Program]) -> Iterator[Emitted]:
    for program in programs:
        instance = program.instance
        what = "node" if isinstance(program, FlatNode) else "process"
        yield Emitted(_name(program), f"{what} {instance.name!r}", instance.name_span)


def _faults(program: _Program) -> Iterator[Diagnostic]:
    yield from faults_of(program, COMPOSE)
    respawn = program.instance.respawn
    if respawn is not None and respawn.max_restarts is not None:
        yield report(
            codes.UNSUPPORTED_BY_TARGET,
            f"compose knows no 'max' for '{program.instance.name}': it counts the restarts of what"
            " has failed, and not those of what has ended",
            program.instance.name_span,
            "leave 'max' out, or start the system with 'deros up', the script or units of systemd",
        )
    if isinstance(program, FlatNode) and is_load_monitor(program):
        yield report(
            codes.UNSUPPORTED_BY_TARGET,
            f"services of compose do not see the processes of one another, so"
            f" '{program.instance.name}' would find no node whose load it can measure",
            program.instance.name_span,
            "start the system with 'deros up', the script, the launch file or units of systemd",
        )
    for file in program.files:
        why = _not_held(file)
        if why:
            yield report(
                codes.UNSUPPORTED_BY_TARGET,
                f"compose files hold the text of parameter files, and '{file.path}' {why}",
                file.path_span,
                "have the file beside the system, or start that with 'deros up', the script or the"
                " launch file",
            )


def _not_held(file: ParameterFile) -> str:
    if file.in_package is not None:
        return "is in a package of the image"
    if posixpath.isabs(file.path):
        return "is where it is on this computer"
    if file.keys or file.given is not None:
        return "is made when the system is started"
    return "" if isinstance(file.load(), Document) else "cannot be read"
