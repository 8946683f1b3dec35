"""The comparison of drawn plates with their links."""

from __future__ import annotations

from linkwright.machine.analysis import Analysis, of
from linkwright.outlines.joints import has_plates

PLATES = Analysis(
    name="plates",
    applies=has_plates,
    make=of("outlines.joints:compare_joints"),
    check=of("outlines.joints:check_plates"),
)
