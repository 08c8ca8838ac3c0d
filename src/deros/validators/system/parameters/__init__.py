"""Checks of parameter files."""
