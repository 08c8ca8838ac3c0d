"""The typed models of the languages, as written."""
