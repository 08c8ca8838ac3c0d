"""Comparison of a running graph with the system that it is meant to be."""
