"""Findings: which ones are allowed, and which only follow from others."""
