"""Starts the parts of a system on several hosts, over ssh."""
