"""Syntax errors: all those of a file, what is meant, and the rest of its model."""
