"""What a generator makes of a model."""

from __future__ import annotations

from pathlib import Path

from deros.generators.api.protocol import Context, Files, GenerateFunction
from deros.interfaces.store import InterfaceStore
from deros.metamodels.load import Repository


def output_of(
    generate: GenerateFunction, path: str | Path, text: str | None = None, **options: str
) -> Files:
    """Return the files generated from a model, which must load without a finding.

    Args:
        generate: the generator.
        path: the file of the model.
        text: what takes the place of its text; the file need not exist then.
        options: of the generator.
    """
    context = Context(InterfaceStore(), Repository())
    if text is None:
        loaded = context.repository.load(path)
    else:
        loaded = context.repository.load_text(path, text)
    assert loaded.diagnostics == ()
    assert loaded.model is not None
    return generate(loaded.model, context, options)
