"""The monitor in Python: one pure module, straight-line code with one-shot deadlines."""
