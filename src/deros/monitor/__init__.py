"""What rules mean: the monitor's intermediate form, and the reference engine that defines it."""
