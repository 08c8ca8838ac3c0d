"""Checks of safety rules."""
