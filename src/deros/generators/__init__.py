"""Generators: pure functions from a typed model to files, and one writer that touches the disk."""
