"""Gates: their table, and their reference on plain data."""
