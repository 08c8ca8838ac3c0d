"""Checks of how the nodes of a system come to run: their states, and their time."""
