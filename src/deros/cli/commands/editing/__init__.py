"""Commands that change the texts of models."""
