"""Checks of the safety nodes of systems."""
