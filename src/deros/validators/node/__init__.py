"""Checks of node descriptions."""
