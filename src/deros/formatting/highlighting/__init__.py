"""Colours for the texts of models, from the words of their grammars."""
