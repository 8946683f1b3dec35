"""Pairs of motor and gearbox: tables of those that pass, of refusals and feasible ratios; all as CSV."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from linkwright.axes.choice import CHECKS, ServoChoice
from linkwright.axes.feasibility import RatioRange, load_factor, ratio_range
from linkwright.kernel.check import title_of
from linkwright.kernel.page.checks import check_table
from linkwright.kernel.page.table import Row, Table, csv_text, part_table
from linkwright.kernel.reader.numbers import measured, number

# Pairs and motors that a table shows.
_SHOWN = 10


def choice_tables(name: str, choice: ServoChoice) -> Iterator[Table]:
    """The best pairs for an axis, or the nearest one; checks of the first, refusals, feasible ratios."""
    pairs = choice.order[:_SHOWN].tolist() or [choice.nearest]
    words = "Motors and gearboxes" if len(choice.order) else "No pair passes; the nearest"
    rows = [_pair_row(choice, *pair) for pair in pairs]
    heads = (
        "motor",
        "gearbox",
        "ratio",
        "power",
        "cost",
        "rms torque",
        "peak torque",
        "top speed",
        "inertia",
    )
    yield Table(f"choice_{name}", f"{words} for axis {name}: shares of what is permitted", heads, rows)
    first = pairs[0]
    title = f"{choice.motors[first[0]].type} with {choice.gearboxes[first[1]].type}"
    yield check_table(f"choice_{name}_checks", title, choice.duty(*first).checks)
    if refused := choice.refused:
        counts: list[Row] = [(title_of(check), "", str(pairs)) for check, pairs in refused.items()]
        total = len(choice.motors) * len(choice.gearboxes)
        yield Table(
            f"choice_{name}_refused", f"Refused of {total} pairs", ("check", "", "fails or not known"), counts
        )
    yield ratio_table(name, choice)


def _pair_row(choice: ServoChoice, motor: int, gearbox: int) -> Row:
    servo, gears = choice.motors[motor], choice.gearboxes[gearbox]
    costs = servo.cost, gears.cost
    cost = None if None in costs else sum(each for each in costs if each is not None)
    used = dict(zip(CHECKS, choice.utilisation[:, motor, gearbox].tolist(), strict=True))
    return (
        servo.type,
        gears.type,
        f"{gears.gearbox.ratio:.4g}",
        measured(servo.power_rated, "W", usual="kW"),
        number(cost),
        *(_share(used[check]) for check in ("torque_rms", "torque_peak", "speed", "inertia_ratio")),
    )


def _share(used: float) -> str:
    return "not known" if np.isnan(used) else f"{100 * used:.3g} %"


def ratio_table(name: str, choice: ServoChoice) -> Table:
    """Feasible ratios of the motors that come first."""
    load = load_factor(choice.cycle)
    heads = ("motor", "accelerating factor α", "best ratio", "rms torque there", "from", "to")
    return part_table(
        f"choice_{name}_ratios",
        f"Feasible ratios by continuous torque; load factor β = {number(load.load_factor)} W/s",
        shown_ranges(choice),
        heads,
        *("type", "accelerating_factor", "ratio_best", "torque_rms_best", "ratio_min", "ratio_max"),
    )


def shown_ranges(choice: ServoChoice) -> list[RatioRange]:
    """Feasible ratios of the motors of the best pairs, or without any of the strongest for their inertia."""
    load = load_factor(choice.cycle)
    motors = list(dict.fromkeys(choice.order[:, 0].tolist()))[:_SHOWN]
    chosen = [choice.motors[motor] for motor in motors] or list(choice.motors)
    ranges = [ratio_range(load, servo.motor, type=servo.type, extra=choice.coupling) for servo in chosen]
    return (
        sorted(ranges, key=lambda found: -(found.accelerating_factor or 0.0))[:_SHOWN]
        if not motors
        else ranges
    )


def choice_headline(name: str, choice: ServoChoice) -> str:
    """What was chosen and why, or that nothing suffices."""
    total = len(choice.motors) * len(choice.gearboxes)
    if not len(choice.order):
        motor, gearbox = choice.nearest
        reasons = ", ".join(check.brief for check in choice.duty(motor, gearbox).failed)
        return (
            f"axis {name}: none of {total} pairs of motor and gearbox suffices; the nearest, "
            f"{choice.motors[motor].type} with {choice.gearboxes[gearbox].type}, is refused: {reasons}"
        )
    servo, gears = (
        parts[place].type
        for parts, place in zip((choice.motors, choice.gearboxes), choice.order[0], strict=True)
    )
    return (
        f"axis {name}: {servo} with {gears} passes all checks with the lowest {_GOALS[choice.goal]}; "
        f"{len(choice.order)} of {total} pairs pass"
    )


# Criteria in words.
_GOALS = {
    "cost": "cost",
    "power": "rated power",
    "inertia": "inertia of the rotor",
    "rms": "utilisation of the continuous torque",
}


def pairs_csv(choice: ServoChoice) -> str:
    """Every pair with the utilisation of every check, and the checks that refuse it."""
    heads = ("motor", "gearbox", "ratio [-]", "passes", *(f"{check} [-]" for check in CHECKS), "refused_by")
    used = np.moveaxis(choice.utilisation, 0, -1).tolist()
    passes = choice.passes.tolist()

    def rows() -> Iterator[list[str | float]]:
        for m, servo in enumerate(choice.motors):
            for g, gears in enumerate(choice.gearboxes):
                shares = used[m][g]
                # NaN, not known, refuses too.
                refused = [
                    check for check, share in zip(CHECKS, shares, strict=True) if not share <= 1 + 1e-12
                ]
                verdict = "yes" if passes[m][g] else "no"
                yield [servo.type, gears.type, gears.gearbox.ratio, verdict, *shares, " ".join(refused)]

    return csv_text(heads, rows())
