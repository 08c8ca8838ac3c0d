"""Decoders in Python: one pure module that reads single fields of serialized messages."""
