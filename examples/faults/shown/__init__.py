"""Faults of the wheeled robots, one after the other: each started, watched and drawn."""
