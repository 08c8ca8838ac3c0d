"""The languages: grammars, loader and typed models."""
