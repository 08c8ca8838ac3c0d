"""Converts safety rules (`*.deros`)."""
