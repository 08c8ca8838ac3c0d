"""Codes of zones, the areas that safety rules name, and of where sensors are on the robot."""

from __future__ import annotations

from deros.diagnostics import Severity, declare

ZONE_WITHOUT_AREA = declare(601, "zone-without-area", "zone that has no area")
ZONE_EDGES_MEET = declare(602, "zone-edges-meet", "polygon whose edges cross or touch")
ZONE_CORNER_TWICE = declare(603, "zone-corner-twice", "corner that a polygon has twice")
UNUSED_ZONE = declare(604, "unused-zone", "unused zone", Severity.WARNING, absence=True)
UNSUPPORTED_ZONE = declare(605, "unsupported-zone", "zone that rules cannot have")
BAD_MOUNTING = declare(610, "bad-mounting", "mounting that a sensor cannot have")
ZONE_SEEN_TWICE = declare(
    611, "zone-seen-twice", "zone measured from different places", Severity.WARNING
)
