"""Commands for those who write models, and for their editors."""
