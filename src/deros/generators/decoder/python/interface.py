"""What other parts of the generators use of the decoders in Python."""

from deros.generators.decoder.python.render import Topic, render_decoders

__all__ = ["Topic", "render_decoders"]
