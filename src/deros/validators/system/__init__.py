"""Checks of system descriptions."""
