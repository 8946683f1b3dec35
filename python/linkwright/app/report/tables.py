"""Results of a study as tables of text, for the page and for the terminal."""

from __future__ import annotations

from collections.abc import Iterator

from linkwright.app.study import Study
from linkwright.drive.tables import drive_tables, numerical_tables
from linkwright.drive.tables_of_cycle import cycle_tables
from linkwright.kernel.page.table import Table
from linkwright.kinetostatics.tables import envelope_table
from linkwright.linkages.tables import loop_tables, transmission_tables, travel_tables

# What the page has first, below the sketch, and what it has last.
MOTION_TABLES = ("linkage", "motion", "transmission")
DETAIL_TABLES = ("grashof", "dead_points", "numerical")


def tables(study: Study) -> list[Table]:
    """All results of a study as tables: its subject, motion, drive, forces, and numerical details last."""
    first = [*_slices(study), *_motion(study), *drive_tables(study)]
    forces = envelope_table(study.forces) if study.forces else None
    return [*first, *([forces] if forces is not None else []), *_rest(study)]


def _motion(study: Study) -> Iterator[Table]:
    """Strokes and time ratios, the motion, transmission angles."""
    if study.linkage is not None and study.motion is not None:
        yield from travel_tables(study.linkage)
        yield from cycle_tables(study.motion, study.linkage)
        yield from transmission_tables(study.linkage)


def _rest(study: Study) -> Iterator[Table]:
    """Loops and dead points, and how the numbers were found."""
    if study.linkage is not None:
        yield from loop_tables(study.linkage)
    yield from numerical_tables(study)


def _slices(study: Study) -> Iterator[Table]:
    """Those of turning moments, topper, cams and pumping unit, where the machine has such."""
    if study.turning_moment is not None:
        from linkwright.turning.tables import turning_tables

        yield from turning_tables(study.turning_moment)
    if study.knife is not None:
        from linkwright.topping.tables.topper import topper_tables

        yield from topper_tables(*study.knife)
    if study.cams:
        from linkwright.cam.tables import cam_tables

        yield from cam_tables(study.cams, study.cam_sizes, study.loaded_cams)
    if study.pumping_unit is not None or study.rotator is not None:
        from linkwright.pumping.tables import unit_tables

        yield from unit_tables(study.pumping_unit, study.rotator)
