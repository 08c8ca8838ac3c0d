"""A fourth language: its declaration, its model, its converter, its check and its scaffold."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

from deros import codes
from deros.diagnostics import Diagnostic, SourceFile, Span, report
from deros.metamodels.languages import Language
from deros.metamodels.load import Loading
from deros.validators.findings.context import CheckContext

_HERE = "tests.plugins.recording_language.language"

RECORDING = Language(
    name="recording",
    suffix=".recording",
    kind="recording",
    title="recordings",
    description="Recordings: the topics of a bag",
    grammar=str(Path(__file__).with_name("recording.tx")),
    loader=f"{_HERE}:load",
    checks=f"{_HERE}:check",
    scaffold=f"{_HERE}:SCAFFOLD",
)

SCAFFOLD = {"$name.recording": "recording $name topics /odom\n"}


@dataclass(frozen=True)
class Recording:
    """The topics of one bag, with their positions."""

    name: str
    source: SourceFile
    topics: tuple[tuple[str, Span], ...]


def load(loading: Loading) -> Recording:
    """Convert the textX model."""
    model = loading.parse()
    topics = tuple(
        (str(topic), Span(loading.source, topic.start, topic.end)) for topic in model.topics
    )
    return Recording(str(model.name), loading.source, topics)


def check(recording: Recording, context: CheckContext) -> Iterator[Diagnostic]:
    """Yield a finding for each topic that is recorded twice."""
    del context
    seen = set()
    for topic, span in recording.topics:
        if topic in seen:
            yield report(codes.DUPLICATE_TOPIC, f"'{topic}' is recorded twice", span)
        seen.add(topic)
