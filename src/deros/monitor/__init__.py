"""The semantics of rules: the intermediate form, and the reference engine that defines it."""
