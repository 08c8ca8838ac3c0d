"""Commands for the formats of other tools."""
