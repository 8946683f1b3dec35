"""All analyses, in the order in which a study makes them and a report shows them."""

from __future__ import annotations

from linkwright.axes import analyses as axes
from linkwright.cam import analyses as cam
from linkwright.drive import analyses as drive
from linkwright.driveline import analyses as driveline
from linkwright.kinetostatics import analyses as kinetostatics
from linkwright.linkages import analyses as linkages
from linkwright.outlines import analyses as outlines
from linkwright.pumping import analyses as pumping
from linkwright.rods import analyses as rods
from linkwright.topping import analyses as topping
from linkwright.torsion import analyses as torsion
from linkwright.turning import analyses as turning

ANALYSES = (
    *(turning.DIAGRAM, topping.TOPPER, topping.FIELD),
    *(cam.CAM, cam.SIZES, cam.CHECK),
    *(pumping.UNIT, pumping.GEARBOX, pumping.ROTATOR),
    outlines.PLATES,
    *(linkages.LINKAGE, drive.MOTION, drive.CYCLE, drive.REDUCTION, drive.CONSTANT_ENERGY, drive.STEADY),
    *(drive.STEP_METHOD, drive.RUN_UP, drive.RUN_DOWN, driveline.ELASTIC, driveline.RUN_UP),
    rods.STRING,
    rods.CARD,
    *(kinetostatics.FORCES, kinetostatics.CYLINDER),
    *(cam.FORCE, cam.VIBRATION, kinetostatics.CONTACT_LOSSES),
    *(axes.AXIS, axes.BUS, axes.TIMING),
    *(torsion.TORSION, torsion.FREE, torsion.DAMPED, torsion.FORCED, torsion.STRESS),
)
