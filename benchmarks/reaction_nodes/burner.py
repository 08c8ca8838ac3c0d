"""Load: keeps one processor busy, at normal priority, until a signal ends it."""

from __future__ import annotations

import contextlib


def main() -> None:
    """Count."""
    number = 0
    with contextlib.suppress(KeyboardInterrupt):
        while True:
            number += 1


if __name__ == "__main__":
    main()
