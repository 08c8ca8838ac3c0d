"""Units of systemd, for certain values of the arguments."""

from __future__ import annotations

import shlex
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass
from pathlib import PurePosixPath

from deros import codes
from deros.diagnostics import Diagnostic, Span, report
from deros.generators.api.protocol import (
    Context,
    File,
    Files,
    GenerationError,
    OptionError,
    Options,
)
from deros.generators.system.described import not_made
from deros.generators.system.script.generate import declared_to_run, system_to_run, table
from deros.generators.system.script.standalone.arguments import given
from deros.generators.system.script.standalone.command_line import parameter_file
from deros.generators.system.script.standalone.node import Row
from deros.generators.system.systemd.units import Service, service, specified
from deros.generators.system.unsupported import composed_node
from deros.generators.system.view import SystemView, system_view
from deros.generators.text.identifiers import Emitted, check_collisions
from deros.generators.text.templates import environment
from deros.models.arguments import Lookup
from deros.models.parameter_files import ParameterFile
from deros.models.starting import Starting
from deros.models.system import System
from deros.systems.arguments.lookups import looked_up
from deros.systems.flat import FlatLaunch, FlatNode, FlatProcess, FlatSystem
from deros.systems.flatten import flatten
from deros.systems.running.autostart import manager_of
from deros.systems.running.placement import placed


@dataclass(frozen=True, slots=True)
class Holder:
    """What a target is called that holds the values of a system, in what it refuses.

    Attributes:
        many: its files.
        one: what stands for one program.
        of_program: that, of a program.
        starts: how they are started together.
        folder: why a relative path leads nowhere.
    """

    many: str
    one: str
    of_program: str
    starts: str
    folder: str


UNITS = Holder(
    "units",
    "a unit of systemd",
    "unit",
    "systemd starts all units at once, and stops each on its own",
    "a unit is started in no certain folder",
)
FOLDER = "systemd"
_Program = FlatNode | FlatProcess
SETUP = "/opt/ros/jazzy/setup.bash"


def generate(model: System, context: Context, options: Options) -> Files:  # noqa: ARG001
    """Return a unit for each node and process, and the target.

    Raises:
        GenerationError: if units cannot do what the system says; each of its reasons is named.
        OptionError: if a value of an argument, or the setup file, cannot be used.
    """
    setup = setup_file(options)
    system = with_values(placed(model), assignments(options.get("arguments", "")))
    view, flat = system_view(system), flatten(system)
    rows = table(view)
    programs = [each for each in flat.programs if not isinstance(each, FlatLaunch)]
    if flat.launches:
        raise GenerationError([launched(each) for each in flat.launches])
    faults = [fault for each in zip(programs, rows, strict=True) for fault in _faults(*each)]
    if faults:
        raise GenerationError(faults)
    check_collisions(_emitted(view, programs), "the units of systemd")
    services = _services(view, flat, programs, rows, setup)
    made = environment("deros.generators.system.systemd")
    files = {f"{FOLDER}/{view.stem}.target": File(_target(view, services))}
    template = made.get_template("service.j2")
    for each in services:
        text = template.render(service=each, stem=view.stem)
        files[f"{FOLDER}/{each.name}"] = File(text)
    return files


def _target(view: SystemView, services: tuple[Service, ...]) -> str:
    description = view.description or view.name
    made = environment("deros.generators.system.systemd")
    return made.get_template("target.j2").render(
        description=specified(description).rstrip("\\"), services=services
    )


def _services(
    view: SystemView,
    flat: FlatSystem,
    programs: Sequence[_Program],
    rows: tuple[Row, ...],
    setup: str,
) -> tuple[Service, ...]:
    descriptions = [each.description for each in view.programs]
    return tuple(
        service(
            row,
            _unit(view, program),
            description.rstrip("\\"),
            [_unit(view, each) for each in activated_by(program, flat)],
            setup,
        )
        for program, row, description in zip(programs, rows, descriptions, strict=True)
    )


def _unit(view: SystemView, program: _Program) -> str:
    name = program.full_name.removeprefix("/").replace("/", "-")
    return f"{view.stem}-{name}.service"


def _emitted(view: SystemView, programs: Iterable[_Program]) -> Iterator[Emitted]:
    for program in programs:
        instance = program.instance
        what = "node" if isinstance(program, FlatNode) else "process"
        yield Emitted(_unit(view, program), f"{what} {instance.name!r}", instance.name_span)


def activated_by(manager: _Program, flat: FlatSystem) -> Iterator[FlatNode]:
    """Yield the nodes that a node brings to active: they are started first, and stopped last."""
    nodes = {node.full_name: node for node in flat.nodes}
    for node in flat.nodes:
        if manager_of(node, nodes) is manager:
            yield node


# Options ------------------------------------------------------------------------------------------


def setup_file(options: Options) -> str:
    """Return the path of the file that sets up the shell: the option ``setup``.

    Raises:
        OptionError: if it is not absolute.
    """
    setup = options.get("setup", SETUP)
    if not setup.startswith("/") or not setup.isprintable():
        raise OptionError(f"setup file {setup!r} is not an absolute path")
    return setup


# Values of the arguments --------------------------------------------------------------------------


def assignments(text: str) -> list[str]:
    """Return the words of an option that gives values of arguments.

    Raises:
        OptionError: if a quote is not closed.
    """
    try:
        return shlex.split(text)
    except ValueError as error:
        raise OptionError(f"arguments {text!r} cannot be taken apart: {error}") from None


def with_values(model: System, words: list[str], holder: Holder = UNITS) -> System:
    """Return the system for the values that are given, and the defaults of all other arguments.

    Raises:
        GenerationError: if something is looked up where the system is started.
        OptionError: if a value is missing or wrong; it says what is meant.
    """
    lookups: list[Lookup] = []
    view = system_view(model)

    def note(lookup: Lookup) -> str:
        lookups.append(lookup)
        return ""

    if model.is_computed:
        looked_up(model, note)
    if lookups:
        raise GenerationError([_looked_up(each, holder) for each in lookups])

    try:
        values = given(declared_to_run(view, {}), words)
        return system_to_run(model, values, {})
    except ValueError as fault:
        raise OptionError(str(fault)) from None


def _looked_up(lookup: Lookup, holder: Holder) -> Diagnostic:
    if lookup.made is not None:
        return report(
            codes.UNSUPPORTED_BY_TARGET,
            f"file '{lookup.name}' is made when the system is started, and {holder.many} hold"
            " values",
            lookup.span,
            "start the system with 'deros up', the script or the launch file",
        )
    return report(
        codes.UNSUPPORTED_BY_TARGET,
        f"'{lookup.span.text}' is looked up where the system is started, and {holder.many} hold"
        " values",
        lookup.span,
        f"make it an argument, whose value is given when the {holder.many} are generated",
    )


# What units cannot do -----------------------------------------------------------------------------


def launched(launch: FlatLaunch, holder: Holder = UNITS) -> Diagnostic:
    """Return the finding that a launch file is no program."""
    return report(
        codes.UNSUPPORTED_BY_TARGET,
        f"'{launch.launch.path}' starts its nodes itself, and {holder.one} is for one program",
        launch.launch.path_span,
        "start the system with 'deros up', the script or the launch file",
    )


def _starting(name: str, starting: Starting, holder: Holder) -> Iterator[Diagnostic]:
    found = [
        ("delay", None if starting.delay is None else starting.delay.span),
        ("after exit of", None if starting.after is None else starting.after.span),
        ("on exit stop all", starting.stops_all),
    ]
    if starting.ready is not None:
        found.append((f"after {starting.ready.kind}", starting.ready.span))
    for words, span in found:
        if span is not None:
            yield report(
                codes.UNSUPPORTED_BY_TARGET,
                f"'{words}' of '{name}' is not in its {holder.of_program}: {holder.starts}",
                span,
                "start the system with 'deros up', the script or the launch file",
            )


def faults_of(program: _Program, holder: Holder = UNITS) -> Iterator[Diagnostic]:
    """Yield what a program is to do and cannot, besides reading files."""
    yield from _starting(program.instance.name, program.instance.starting, holder)
    name = program.instance.name
    if isinstance(program, FlatProcess):
        yield from _relative_paths(program, holder)
        return
    many = holder.many
    if program.container is not None:
        yield composed_node(program, f"{many} start programs, and do not load '{name}' into one")
        return
    if program.autostart is not None:
        yield report(
            codes.UNSUPPORTED_BY_TARGET,
            f"{many} start programs, and do not bring '{name}' to active",
            program.autostart.span,
            "start the system with 'deros up', the script or the launch file, or have a lifecycle"
            " manager activate the node ('activated by')",
        )
    yield from not_made(program, f"{many} hold values")


def _faults(program: _Program, row: Row) -> Iterator[Diagnostic]:
    yield from faults_of(program)
    if isinstance(program, FlatProcess) or program.container is None:
        instance = program.instance
        yield from _needed_files(instance.name, program.files, row, instance.name_span)


def _needed_files(
    name: str, files: tuple[ParameterFile, ...], row: Row, place: Span
) -> Iterator[Diagnostic]:
    """Yield what a program can be given in a file only."""
    if files:
        yield report(
            codes.UNSUPPORTED_BY_TARGET,
            f"'{name}' reads parameter files, which units do not pass on",
            files[0].path_span,
            "start the system with 'deros up', the script or the launch file",
        )
    elif parameter_file(row) is not None:
        what = f"a parameter of '{name}' has"
        why = " a name that no command line of ROS 2 can hold, or a very long text"
        if row.inside:
            what, why = (
                f"parameters in the process of '{name}' are",
                " for one node each, in a file",
            )
        yield report(
            codes.UNSUPPORTED_BY_TARGET,
            what + why,
            place,
            "start the system with 'deros up', the script or the launch file",
        )


def _relative_paths(process: FlatProcess, holder: Holder) -> Iterator[Diagnostic]:
    instance = process.instance
    folder, program = instance.folder, instance.program
    if folder is not None and not PurePosixPath(folder.text).is_absolute():
        yield report(
            codes.UNSUPPORTED_BY_TARGET,
            f"the folder '{folder.text}' of '{instance.name}' is relative: {holder.folder}",
            folder.span,
            "write an absolute path",
        )
    if folder is None and "/" in program.text and not PurePosixPath(program.text).is_absolute():
        yield report(
            codes.UNSUPPORTED_BY_TARGET,
            f"the program '{program.text}' of '{instance.name}' is a relative path:"
            f" {holder.folder}",
            program.span,
            "write an absolute path, or the folder that it runs in ('cwd')",
        )
