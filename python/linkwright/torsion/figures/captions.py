"""The figures of a study of torsional vibration, with their captions."""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from typing import TYPE_CHECKING

import numpy as np

from linkwright.kernel.errors import LinkwrightError
from linkwright.kernel.figure.style import CaptionedFigure
from linkwright.torsion.figures.forced import (
    gear_figure,
    heat_figure,
    orders_figure,
    overlay_figure,
    shaft_torques_figure,
    stress_figure,
    torsion_unevenness_figure,
)
from linkwright.torsion.figures.friction import friction_figure
from linkwright.torsion.figures.modes import campbell_figure, in_a_row, modes_figure
from linkwright.torsion.figures.scheme import scheme_figure
from linkwright.torsion.figures.stars import star_figure
from linkwright.torsion.figures.transient import transient_figure, waterfall_figure
from linkwright.torsion.in_time.transient import TorsionTransient
from linkwright.torsion.in_time.waterfall import waterfall
from linkwright.torsion.modes.phase_vectors import most_severe
from linkwright.torsion.response.forced import ForcedVibration, angular_deflection
from linkwright.torsion.response.stress import ShaftStress
from linkwright.torsion.study import TorsionStudy
from linkwright.torsion.tables.limits import measured_words, words
from linkwright.torsion.tables.torsion import service_place

if TYPE_CHECKING:
    from matplotlib.figure import Figure

# Star diagrams in a figure.
_STARS = 8

# Shafts in the figure of a manoeuvre with ice.
_SHOWN = 4

# Share of its highest speed below which a disc stands as good as still.
_TURNING = 0.02


def torsion_figures(study: TorsionStudy) -> Iterator[CaptionedFigure]:
    """The figures that a study has results for."""
    caption = "The height of a disc is its inertia, the length of a shaft its compliance."
    yield CaptionedFigure("scheme", "Equivalent scheme", caption, scheme_figure(study.scheme))
    caption = "Amplitudes of the lowest elastic modes; the largest is 1."
    yield CaptionedFigure("mode_shapes", "Mode shapes", caption, modes_figure(study.free))
    if study.forced is not None:
        yield from _forced(study, study.forced)
    if study.transient is not None:
        yield from _manoeuvre(study, study.transient)


def _manoeuvre(study: TorsionStudy, moved: TorsionTransient) -> Iterator[CaptionedFigure]:
    caption = "Speeds of discs and torques of the shafts with the largest amplitudes; extremes are marked."
    marks = [(one.start, "ice") for one in moved.ice]
    marks += [(one.end, "") for one in moved.ice if one.end is not None]
    caption += " Dotted: the first impact of ice, and the end of the last." if marks else ""
    yield CaptionedFigure("transient", "Manoeuvre", caption, _moving(study, moved, marks))
    if moved.frictions:
        caption = "Slip and torque of clutches, brakes and freewheels; shaded where they stick or lock."
        yield CaptionedFigure("transient_friction", "Friction", caption, friction_figure(moved))
    # Orders are found by revolutions: while the first disc stands there are none.
    turning = moved.speed[0] > _TURNING * moved.speed[0].max()
    first = int(np.argmax(turning))
    angle = moved.angle[0, first:]
    if not moved.shafts or not turning[first:].all() or not (np.diff(angle) > 0).all():
        return
    shaft = int(np.argmax(moved.torque_max - moved.torque_min))
    try:
        orders = waterfall(moved.time[first:], angle, moved.torque[shaft, first:])
    except LinkwrightError:
        # silent: a record too short for orders has no waterfall
        # Too short for turns to tell orders apart.
        return
    if len(orders.time) < 2:  # One window shows no change of speed.
        return
    caption = f"Torque in {moved.shafts[shaft]}, order by order as the speed changes [N m]."
    figure = waterfall_figure(orders, quantity="torque [N m]")
    yield CaptionedFigure("waterfall", "Waterfall of the manoeuvre", caption, figure)


def _moving(study: TorsionStudy, moved: TorsionTransient, marks: Sequence[tuple[float, str]]) -> Figure:
    """The shafts that swing most; with ice, that of the propeller before them, and the propeller's speed."""
    train, hit = study.machine.train, {one.on for one in moved.ice}
    if train is None or not hit:
        return transient_figure(moved, marks=marks)
    beside = [name for name, shaft in train.shafts.items() if hit & set(shaft.between)]
    swing = moved.torque_max - moved.torque_min
    others = [moved.shafts[s] for s in np.argsort(-swing, kind="stable")]
    shown = list(dict.fromkeys([*beside, *others]))[:_SHOWN]
    return transient_figure(moved, shafts=shown, discs=[moved.discs[0], *sorted(hit)], marks=marks)


def _forced(study: TorsionStudy, forced: ForcedVibration) -> Iterator[CaptionedFigure]:
    if study.campbell is not None:
        caption = "Natural frequencies and excitation orders over the speed, with their intersections."
        yield CaptionedFigure("campbell", "Critical speeds", caption, campbell_figure(study.campbell))
    if forced.shafts:
        caption = "Vibratory torque (half the peak-to-peak value), orders summed in phase."
        yield CaptionedFigure("torques", "Torque of the shafts", caption, shaft_torques_figure(forced))
    if study.stress is not None:
        caption = "Vibratory shear stress with its concentration; dashed: permitted."
        barred = () if study.verdict is None else study.verdict.barred
        caption += " Shaded are barred speed ranges." if barred else ""
        yield CaptionedFigure("stress", "Stress of the shafts", caption, stress_figure(study.stress, barred))
    for one in study.overlays:
        caption = f"Dots: measured. Line: computed. {measured_words(one)}"
        yield CaptionedFigure(f"measured_{one.name}", f"Measured {words(one)}", caption, overlay_figure(one))
    if forced.shafts:
        yield _of_the_worst_shaft(study, forced)
    if study.stars and study.campbell is not None:
        caption = (
            "Phase vectors of throws and discs, with the length of their amplitude in the mode. Red: the "
            "vector sum, relative to the sum of all lengths."
        )
        stars = most_severe(study.campbell, study.stars, _STARS)
        yield CaptionedFigure("stars", "Star diagrams", caption, star_figure(stars))
    if study.meshes is not None and np.isfinite(study.meshes.vibratory).any():
        caption = "Mean torque with the range of its vibration; below zero the teeth lose contact."
        yield CaptionedFigure("gears", "Torque of the gear stages", caption, gear_figure(study.meshes))
    yield _of_the_freest_disc(forced)
    shown = float(forced.speeds[service_place(study, forced)])
    caption = (
        f"Along the train at {shown * 30 / math.pi:.5g} rpm, and over the speed. The parts are not in "
        "phase and do not add up."
    )
    figure = torsion_unevenness_figure(forced, in_a_row(forced.discs, study.free.joined), shown)
    yield CaptionedFigure("unevenness", "Speed fluctuation", caption, figure)
    parts = _heated(study, forced)
    if parts:
        yield CaptionedFigure("heat", "Heat", "Mean power dissipated by damping.", heat_figure(forced, parts))


def _of_the_worst_shaft(study: TorsionStudy, forced: ForcedVibration) -> CaptionedFigure:
    worst = worst_shaft(forced, study.stress)
    name = forced.shafts[worst]
    single, total = np.abs(forced.shaft_torques[:, worst]), forced.shaft_torque_vibratory[worst]
    figure = orders_figure(forced, single, total, "torque [kN m]", 1e-3)
    return CaptionedFigure(
        "orders", f"Orders in {name}", "Amplitude of each order, and of all orders summed in phase.", figure
    )


def worst_shaft(forced: ForcedVibration, stress: ShaftStress | None) -> int:
    """The shaft that is nearest to its limit of stress; where none has one, that which is twisted most."""
    if stress is not None:
        # Limits may say nothing at some speeds.
        used = np.nan_to_num(stress.utilisation, posinf=np.inf).max(axis=1)
        if used.max() > 0:
            return forced.shafts.index(stress.shafts[int(used.argmax())])
    # Without number is a resonance that nothing damps.
    size = np.nan_to_num(forced.shaft_torque_vibratory, nan=np.inf, posinf=np.inf).max(axis=1)
    return int(size.argmax())


def _of_the_freest_disc(forced: ForcedVibration) -> CaptionedFigure:
    swing = np.nan_to_num(np.abs(forced.amplitudes)).max(axis=(0, 2))
    name = forced.discs[int(swing.argmax())]
    single, total = angular_deflection(forced, name)
    figure = orders_figure(forced, single, total, "angle [°]", 180 / math.pi)
    caption = (
        "Vibration superposed on steady rotation: amplitude of each order, and half the peak-to-peak "
        "value of all orders summed in phase."
    )
    return CaptionedFigure("amplitude", f"Amplitude of {name}", caption, figure)


def _heated(study: TorsionStudy, forced: ForcedVibration) -> list[str]:
    train = study.machine.train
    named = [] if train is None else [*train.dampers, *train.couplings]
    if not named:
        heat = np.nan_to_num(forced.shaft_heat).max(axis=1)
        named = [forced.shafts[s] for s in np.argsort(-heat)[:4] if heat[s] > 0]
    return named[:6]
