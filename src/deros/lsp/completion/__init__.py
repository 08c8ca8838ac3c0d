"""Completion: what fits at a place of a text that somebody is writing."""
