"""Generators: pure functions from a typed model to files, and the one writer that touches the disk."""
