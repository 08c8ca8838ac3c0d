"""Checks of what rules do while a value is lost."""
