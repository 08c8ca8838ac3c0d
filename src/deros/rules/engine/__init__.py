"""The reference engine, which defines what rules mean, and its causes."""
