"""The terms of rules: arithmetic and functions, checked for types and dimensions."""
