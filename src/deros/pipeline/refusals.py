"""What the targets that a project and its systems name would refuse; nothing is generated."""

from __future__ import annotations

from typing import TYPE_CHECKING

from deros.interfaces.files import asks_elsewhere
from deros.pipeline.known_options import known_options
from deros.pipeline.project import project_of, targets_of
from deros.validators.rules_walk import topics_read

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator, Sequence

    from deros.diagnostics import Diagnostic
    from deros.generators.api.protocol import Context
    from deros.metamodels.load import LoadedFile, Repository
    from deros.models.common import Name
    from deros.models.rules import Rules
    from deros.models.system import Subsystem, System


def refusals(
    files: Sequence[LoadedFile], repository: Repository, context_of: Callable[[], Context]
) -> list[Diagnostic]:
    """Return the findings of the targets of models without errors: what they cannot express.

    The targets of a model are those that its project file names for its language and, of rules,
    the one that a ``safety`` statement of a checked system names. Descriptions of existing programs
    have none.

    Args:
        files: the models that count as named by the user.
        repository: where they were loaded.
        context_of: makes what the generators share, if there is a target.
    """
    from deros import codes
    from deros.generators.api.protocol import GenerationError, OptionError
    from deros.generators.api.registry import discover

    found: dict[Diagnostic, None] = {}
    context = None
    for file, target in _targets(files, repository):
        language = file.language
        generator = None if language is None else discover().find(language.name, target)
        if generator is None:  # the project file has a finding of its own
            continue
        program = generator.function.__module__
        if program.partition(".")[0] != "deros":
            asks_elsewhere(program)
        context = context or context_of()
        options = known_options(generator, project_of(file.path).options)
        try:
            generator(file.model, context, options)
        except GenerationError as error:
            refused = (e for e in error.diagnostics if e.code is codes.UNSUPPORTED_BY_TARGET)
            found |= dict.fromkeys(refused)
        except OptionError:  # `deros generate` says which
            continue
    return list(found)


def _targets(
    files: Sequence[LoadedFile], repository: Repository
) -> Iterator[tuple[LoadedFile, str]]:
    """Yield each model with each of its targets, once."""
    from deros.models.node import NodeType
    from deros.models.system import System

    wanted: dict[tuple[str, str], LoadedFile] = {}
    for file in files:
        if isinstance(file.model, NodeType) and file.model.executable is not None:
            continue
        for target in targets_of(file.path):
            wanted.setdefault((file.path, target), file)
        if isinstance(file.model, System):
            for rules, target in _safety(file.model):
                loaded = repository.load(rules)
                wanted.setdefault((loaded.path, target), loaded)
    yield from ((file, target) for (_, target), file in wanted.items())


def _may_watch_itself(rules: Rules) -> bool:
    """Return whether rules read a topic called like that of an action: all that Python refuses."""
    read = {_last(name) for name in topics_read(rules)}
    return any(_last(each.binding.topic) in read for each in rules.actions if each.binding)


def _last(topic: Name) -> str:
    return topic.text.rpartition("/")[2]


def _safety(part: System | Subsystem) -> Iterator[tuple[str, str]]:
    """Yield the file and the target of the rules that safety statements name."""
    from deros.models.system import Subsystem

    for each in part.safety:
        rules = each.reference.rules
        if rules is not None and (each.target != "python" or _may_watch_itself(rules)):
            yield rules.source.path, each.target
    for member in part.members:
        if isinstance(member, Subsystem):
            yield from _safety(member)
