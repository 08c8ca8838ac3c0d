"""Decoders: read single fields out of serialized messages."""
