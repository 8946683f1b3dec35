"""Results of a study as tables of text, for the page and for the terminal."""

from __future__ import annotations

from collections.abc import Iterator

from linkwright.app.study import Study
from linkwright.drive.tables import drive_tables
from linkwright.kernel.page.table import Table
from linkwright.kinetostatics.tables import envelope_table
from linkwright.linkages.tables import linkage_tables


def tables(study: Study) -> list[Table]:
    """All results of a study as tables, without those that have nothing to tell."""
    found = [*_slices(study), *drive_tables(study)]
    forces = envelope_table(study.forces) if study.forces else None
    found += [forces] if forces is not None else []
    return found + (linkage_tables(study.linkage) if study.linkage else [])


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
