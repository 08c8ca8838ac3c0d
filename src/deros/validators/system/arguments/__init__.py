"""Checks of the arguments of systems, and of a system for every combination of them."""
