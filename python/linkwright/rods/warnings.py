"""What a rod string cannot bear, and what its user should know besides: sentences with numbers."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from linkwright.machine.machine import Machine
from linkwright.rods.along import along_rods
from linkwright.rods.diagnosis import CardDiagnosis
from linkwright.rods.many_cards import CardDiagnoses
from linkwright.rods.model.rod_string import RodString
from linkwright.rods.prediction import RodStringMotion, string_of
from linkwright.rods.stress import RodStress

# Accuracy of a solution beyond which the user is warned.
_INACCURATE = 2e-3

# Fluid load of a card over that of the file beyond which they differ.
_DIFFERS = 0.25

# Harmonics of a load by which its damping can be fitted, and a factor at the end of what is sought.
_FEW, _MUCH = 9, 0.9

# Speed over the natural frequency of the string beyond which it is close to resonance.
_RESONANT = 0.6

# Plunger stroke over the stroke below which the rods only stretch.
_STRETCHED = 0.05

# Share of the pump's depth by which the sections may be shorter without a word.
_SHORT = 0.005

# Share of the fluid load by which the effective tension may fall below zero before it is worth a sentence;
# that of a card ripples.
_SMALL, _RIPPLE = 0.01, 0.05

_NO_DAMPING = (
    "The card shows no damping of the rods: it is taken as 0. Give it with --damping if it is known."
)


def string_findings(motion: RodStringMotion) -> Iterator[str]:
    """Sections beyond the Goodman diagram, gearbox and structure beyond their ratings."""
    yield from _goodman(motion.stress)
    gear = motion.gear
    if gear is None:
        return
    peak = max(gear.torque_net_up, gear.torque_net_down)
    if gear.torque_rated is not None and peak > gear.torque_rated:
        yield (
            f"The gearbox is overloaded by the rod string: its torque reaches {peak:.4g} N m, "
            f"{100 * peak / gear.torque_rated:.0f} % of its rating of {gear.torque_rated:.4g} N m."
        )
    if gear.load_rated is not None and motion.load_max > gear.load_rated:
        yield (
            "The structure is overloaded by the rod string: the polished rod carries "
            f"{motion.load_max:.4g} N, "
            f"{100 * motion.load_max / gear.load_rated:.0f} % of its rating of {gear.load_rated:.4g} N."
        )


def _goodman(stress: RodStress) -> Iterator[str]:
    for n, name in enumerate(stress.sections):
        if stress.loading[n] > 1:
            yield (
                f"Section {n + 1} ({name}) is overloaded: its stress reaches "
                f"{stress.stress_max[n] / 1e6:.4g} MPa, "
                f"the modified Goodman diagram permits {stress.stress_permissible[n] / 1e6:.4g} MPa."
            )


def card_findings(found: CardDiagnosis) -> Iterator[str]:
    """Sections beyond the Goodman diagram by the loads of a card."""
    yield from _goodman(found.stress)


def day_findings(machine: Machine, day: CardDiagnoses) -> Iterator[str]:
    """Cards of a day without a diagnosis, and those that show overloaded rods or an overloaded structure."""
    count, faults = len(day.faults), sum(map(bool, day.faults))
    if faults:
        yield f"{faults} of {count} cards were not diagnosed."
    if over := np.count_nonzero(day.loading_max > 1):
        yield (
            f"{over} of {count} cards show overloaded rods: their stress range reaches "
            f"{100 * np.nanmax(day.loading_max):.4g} % of the permissible one."
        )
    rating = None if machine.pumping_unit is None else machine.pumping_unit.rating
    if rating is not None and (over := np.count_nonzero(day.load_max > rating.load)):
        yield (
            f"{over} of {count} cards show an overloaded structure: the polished rod carries up to "
            f"{np.nanmax(day.load_max):.4g} N, {100 * np.nanmax(day.load_max) / rating.load:.0f} % of its "
            f"rating of {rating.load:.4g} N."
        )


def day_warnings(machine: Machine, day: CardDiagnoses) -> Iterator[str]:
    """What should be known of the cards of a day."""
    yield from _well(string_of(machine))
    if day.damping == 0:
        yield _NO_DAMPING


def string_warnings(string: RodString, motion: RodStringMotion) -> Iterator[str]:
    """What should be known of a predicted motion."""
    yield from _buckling(string, motion, _SMALL * motion.fluid_load)
    yield from _well(string)
    yield from _pumping(motion)
    if motion.load_min < 0:
        yield (
            f"The load of the polished rod falls to {motion.load_min:.4g} N: the rods fall more slowly "
            "than the carrier bar; reduce the speed."
        )
    if motion.accuracy > _INACCURATE:
        yield (
            f"Peak loads of the rod string are accurate to {100 * motion.accuracy:.2g} % of their range "
            f"only, with {motion.harmonics} harmonics: the load of the pump falls too suddenly."
        )
    if string.damping is None and "damping_factor" not in string.model_fields_set:
        yield (
            f"The damping of the rod string is assumed: a damping factor of {string.damping_factor:.3g}. A "
            "measured card tells it: `linkwright rods FILE --card`."
        )


def _pumping(motion: RodStringMotion) -> Iterator[str]:
    """A string that only stretches, that resonates, or whose pump loses all that it lifts."""
    ratio = motion.numbers.speed_ratio_tapered
    if ratio > _RESONANT:
        yield (
            f"The rod string is close to resonance: its pumping speed is {ratio:.2f} of its natural "
            "frequency; reduce the speed."
        )
    if motion.plunger_stroke < _STRETCHED * motion.stroke:
        yield (
            f"The rods stretch by {motion.stretch:.4g} m under the fluid load and take up the stroke of "
            f"{motion.stroke:.4g} m: the plunger hardly moves."
        )
    elif motion.production <= 0:
        yield "The pump delivers nothing: slippage takes all that the plunger displaces."


def _well(string: RodString) -> Iterator[str]:
    """What the description leaves out of the well."""
    gap = float(string.pump_depth - string.length)
    if gap > _SHORT * string.pump_depth:
        yield (
            f"The sections end {gap:.4g} m above the pump at {float(string.pump_depth):.4g} m: missing rods "
            "neither weigh nor stretch."
        )
    if string.inclination > np.radians(3):
        yield (
            "The well is inclined: friction of the rods on the tubing is left out; a card counts it as "
            "load of the pump."
        )


def _buckling(string: RodString, result: RodStringMotion | CardDiagnosis, small: float) -> Iterator[str]:
    """Sections in which the effective tension falls below zero, beside a load that is small."""
    along = along_rods(string, result)
    low = along.load.min(axis=1)
    for n, name in enumerate(result.stress.sections):
        inside = np.flatnonzero(along.section == n)
        at = inside[low[inside].argmin()]
        if low[at] < -small:
            yield (
                f"Section {n + 1} ({name}) tends to buckle: the effective tension falls to {low[at]:.4g} N "
                f"at a depth of {along.depth[at]:.4g} m; add sinker bars."
            )


def diagnosis_warnings(string: RodString, found: CardDiagnosis) -> Iterator[str]:
    """What should be known of a diagnosed card."""
    yield from _buckling(string, found, _RIPPLE * found.fluid_load)
    ratio = found.fluid_load / found.fluid_load_file
    if abs(ratio - 1) > _DIFFERS:
        yield (
            f"The pump card shows a fluid load of {found.fluid_load:.4g} N, the machine file "
            f"{found.fluid_load_file:.4g} N: compare fluid level, plunger and calibration of the load cell."
        )
    if found.is_fitted and found.harmonics < _FEW:
        yield (
            f"The damping is uncertain: {found.harmonics} harmonics of the load stand above its noise. "
            "Give it with --damping if it is known."
        )
    elif found.is_fitted and found.damping == 0:
        yield _NO_DAMPING
    elif found.is_fitted and found.damping_factor > _MUCH:
        yield (
            f"The damping that fits the card best, a factor of {found.damping_factor:.3g}, is at the end "
            "of its range: give rod_string.damping with --damping."
        )
    yield from _well(string)
