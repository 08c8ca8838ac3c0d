"""Commands that compare running graphs with models."""
