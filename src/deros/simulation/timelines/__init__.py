"""Timelines: what comes, and what rules must do then; read from tables, played, compared."""
