"""Decoders in Python: one pure module that reads single fields of serialized messages."""

from deros.generators.cdr_python.render import Topic, render_decoders

__all__ = ["Topic", "render_decoders"]
