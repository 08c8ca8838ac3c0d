"""A check runs no launch file."""

raise SystemExit(1)
