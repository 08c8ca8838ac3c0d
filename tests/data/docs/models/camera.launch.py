"""A launch file that no check runs."""

raise SystemExit(1)
