"""The three languages: their grammars, their loader and the typed models that it yields."""
