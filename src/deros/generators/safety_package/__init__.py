"""The packages of safety rules: safety node, monitor and gates together."""
