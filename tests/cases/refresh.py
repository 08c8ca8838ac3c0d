"""Replace the expectations of all cases, or of those named, by the current findings.

    python tests/cases/refresh.py [NAME…]

Review the difference: it is the change in the messages for users.
"""

from __future__ import annotations

import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[2]))

from tests.support import cases

for name in sys.argv[1:] or [*cases.all_cases(), *cases.robots()]:
    cases.refresh(name)
