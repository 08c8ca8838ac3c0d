"""The functions that rules can call: a table, its forms and its memories."""
