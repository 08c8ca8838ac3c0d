"""Message, service and action definitions, field paths and physical units."""
