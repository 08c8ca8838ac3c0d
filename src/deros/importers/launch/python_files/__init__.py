"""Launch files in Python: a process of its own runs one, and says which actions it has made."""
