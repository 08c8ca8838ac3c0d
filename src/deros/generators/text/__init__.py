"""Pieces of emitted text that several generators need, by the language of the text."""
