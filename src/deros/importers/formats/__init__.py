"""Descriptions of other tools: what each format says, as models."""
