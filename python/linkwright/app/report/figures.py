"""The figures of a study with their captions: each says in words what its numbers say."""

from __future__ import annotations

from collections.abc import Iterator

from linkwright.app.study import Study
from linkwright.drive.figures import drive_figures
from linkwright.drive.figures_of_cycle import cycle_figures
from linkwright.kernel.figure.style import CaptionedFigure
from linkwright.kinetostatics.figures import captioned_forces
from linkwright.linkages.figures import linkage_figures


def figures(study: Study) -> Iterator[CaptionedFigure]:
    """The figures that a study has results for, in the order of the page."""
    yield from _slices(study)
    if study.linkage is not None and study.motion is not None:
        yield from cycle_figures(study.motion, study.linkage)
        yield from linkage_figures(study.machine, study.linkage)
    yield from drive_figures(study)
    if study.forces is not None:
        yield from captioned_forces(study.forces)


def _slices(study: Study) -> Iterator[CaptionedFigure]:
    """Those of turning moments, topper, cams and pumping unit, where the machine has such."""
    if study.turning_moment is not None:
        from linkwright.turning.figures import turning_figures

        yield from turning_figures(study.turning_moment)
    if study.knife is not None:
        from linkwright.topping.figures.captions import topper_figures

        yield from topper_figures(study.machine, *study.knife)
    if study.cams:
        from linkwright.cam.figures.captions import cam_figures

        yield from cam_figures(study.cams, study.loaded_cams)
    if study.pumping_unit is not None or study.rotator is not None:
        from linkwright.pumping.figures import unit_figures

        yield from unit_figures(study.pumping_unit, study.rotator)
