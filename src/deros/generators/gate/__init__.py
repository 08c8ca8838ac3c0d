"""Gates: the nodes that let commands through while the safety node allows it."""
