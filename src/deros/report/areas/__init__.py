"""Pictures of the zones of safety rules, and of the sensors that look into them."""
