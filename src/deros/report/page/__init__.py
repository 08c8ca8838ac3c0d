"""A system as one page for the browser: its wiring, findings and variants, in a single file."""
