"""Gates: their fields, what they limit, and what they stop with."""
