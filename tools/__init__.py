"""Programs for the maintainers of deros, run from the repository: ``python -m tools.prove``."""
