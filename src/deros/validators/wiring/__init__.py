"""The wiring of a system: nodes, topics, and what stands at their ends."""
