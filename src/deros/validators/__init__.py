"""Checks: typed models in, diagnostics out. One family of checks per file."""
