"""What programs are started with, the settings of groups, and processes that are not nodes."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

from deros import codes
from deros.metamodels.converters.convert import Sections
from deros.metamodels.converters.convert_starting import STARTING_WORDS, StartingConverter
from deros.metamodels.matching import Token
from deros.models.arguments import Literally
from deros.models.programs import ProcessInstance, Remapping, Respawn, Variable, Word
from deros.models.system import GroupSettings

PROGRAM_WORDS = {
    "Respawn": "respawn",
    "ProgramArguments": "arguments",
    "Prefix": "prefix",
    "Folder": "cwd",
}
"""The modifiers of programs that are given once, by their rules; `env` may be repeated."""

_FIRST = "the settings of a group stand before its first member"


class ProgramConverter(StartingConverter):
    """Converts what programs are started with."""

    def word(self, token: Token) -> Word:
        """Return a text for a program; only texts and integers have one spelling."""
        span = self.token_span(token)
        if token[0] == "$":
            return Word(str(token), span, self._use(token))
        found = self._text(token)
        if not isinstance(found, Literally):
            return Word(str(token).strip('"'), span, found)
        if isinstance(found.value, bool | float):
            what = "a bool" if isinstance(found.value, bool) else "a double"
            self.report(
                codes.UNFIT_COMMAND,
                f"a program is given texts, and {what} has several spellings",
                span,
                f"write the text that is meant: '\"{token}\"'",
            )
        return Word(found.value if isinstance(found.value, str) else str(token), span)

    def _element(self, found: Any) -> Word:
        word = self.word(found.item)
        return replace(word, when=found.when and self.condition(found.when.condition))

    def variable(self, found: Any) -> Variable:
        """Return an environment variable of a node, a process or a group."""
        when = getattr(found, "when", None)
        return Variable(
            str(found.name),
            self.word(found.value),
            self.span(found),
            self.token_span(found.name),
            None if when is None else self.condition(when.condition),
        )

    def program_modifier(self, what: str, modifier: Any) -> dict[str, Any]:
        """Return the field that a modifier of a program sets, other than ``env``."""
        if what == "arguments":
            return {"arguments": tuple(map(self._element, modifier.words))}
        if what == "prefix":
            return {"prefix": self.word(modifier.prefix)}
        if what == "cwd":
            return {"folder": self.word(modifier.folder)}
        delay = 0 if modifier.delay is None else self.duration_ns(modifier.delay)
        if modifier.delay is not None:
            self.check_longest(delay, "a delay", modifier.delay)
        most = None if modifier.max is None else self.integer(modifier.max)
        return {"respawn": Respawn(delay, most, self.only_if(modifier))}

    # Processes -----------------------------------------------------------------------------------

    def process(self, found: Any) -> ProcessInstance:
        """Return a process that is not a node."""
        settings: dict[str, Any] = {}
        variables: list[Variable] = []
        once = Sections(self)
        for modifier in found.modifiers:
            kind = type(modifier).__name__
            if kind == "Variable":
                variables.append(self.variable(modifier))
                continue
            what = {**PROGRAM_WORDS, **STARTING_WORDS, "When": "when"}.get(kind, "description")
            if not once.once(what, self.span(modifier)):
                continue
            if what == "when":
                settings["when"] = self.condition(modifier.condition)
            elif what == "description":
                settings["description"] = self.text(modifier.text)
            elif what not in STARTING_WORDS.values():
                settings |= self.program_modifier(what, modifier)
        settings |= self.starting(found.modifiers)
        return ProcessInstance(
            str(found.name),
            self.word(found.program),
            self.span(found),
            self.token_span(found.name),
            environment=tuple(variables),
            **settings,
        )

    # Groups --------------------------------------------------------------------------------------

    def remapping(self, found: Any) -> Remapping:
        """Return a remapping of a node, or for all nodes of a group."""
        name, name_from = self.computed_name(found.name)
        target, target_from = self.computed_name(found.target)
        return Remapping(
            name,
            target,
            self.span(found),
            self.token_span(found.name),
            self.token_span(found.target),
            target_from,
            None if found.when is None else self.condition(found.when.condition),
            name_from,
        )

    def check_place(self, part: Any, member: str | None) -> None:
        """Report a setting of a group that stands behind a member, ``member`` in words."""
        if member is None:
            return
        kind = type(part).__name__
        token = part.name if kind == "GroupVariable" else part.keyword
        hint = "move it to the head of the system or subsystem"
        if kind == "Settings" and member.startswith("process"):
            hint = "a process has no parameters; for all nodes of the group, move them to its head"
        message = f"this stands behind {member}: {_FIRST}"
        self.report(codes.SYNTAX_ERROR, message, self.token_span(token), hint)


def with_setting(
    settings: GroupSettings,
    *,
    environment: tuple[Variable, ...] = (),
    parameters: tuple[Any, ...] = (),
    remappings: tuple[Remapping, ...] = (),
) -> GroupSettings:
    """Return the settings of a group with more of them behind."""
    return replace(
        settings,
        environment=settings.environment + environment,
        parameters=settings.parameters + parameters,
        remappings=settings.remappings + remappings,
    )
