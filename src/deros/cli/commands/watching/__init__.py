"""``deros watch``: running safety nodes and gates, as they change."""
