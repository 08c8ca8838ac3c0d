"""Systems that are computed from arguments: their meaning, values, variants and marks."""
