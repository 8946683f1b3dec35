"""The printed formulas of paper 2 against the general synthesis, and against one another.

All differences are the largest over many points, as a share of the largest value.
"""

from __future__ import annotations

from itertools import pairwise
from typing import Any

import numpy as np
from numpy.typing import NDArray

from linkwright.cam.profile.profile import CamProfile
from linkwright.papers.paper2.formulas import SECTIONS, Formulas

Floats = NDArray[np.float64]

# Points of a stroke: middles of equal parts, none of them on a joint.
_POINTS = 3600


def checks(formulas: Formulas, profile: CamProfile) -> dict[str, Any]:
    """Differences [–] by name of the check; ``places`` and ``travels`` by the law of the machine [m]."""
    law = profile.cam.lift
    places = [float(law.at(x)) for x in (0.0, *law.breaks[1:4])]
    return {
        "places": places,
        "travels": dict(zip(SECTIONS, np.diff(places).tolist(), strict=False)),
        "motion": [motion_difference(formulas, profile, order) for order in range(4)],
        "chain": {section: _chain(formulas, section) for section in SECTIONS},
        "mirror": _mirror(formulas),
        "joint": _joint(formulas),
        "radius": radius_difference(formulas, profile),
        "radius_joint": _radius_joint(formulas),
        "diameter": diameter_difference(formulas, profile),
    }


def motion_difference(formulas: Formulas, profile: CamProfile, order: int) -> float:
    """(1) to (3), there and back, against the law of the machine at its design speed, derivative by time."""
    time = (np.arange(_POINTS) + 0.5) / _POINTS * formulas.time
    omega = np.pi / formulas.time
    printed = formulas.stroke_motion(time, order)
    there, back = (profile.cam.lift.at(omega * time + turn, order) * omega**order for turn in (0, np.pi))
    start = formulas.stroke if order == 0 else 0.0
    return max(_share(there, printed), _share(back, start - printed))


def radius_difference(formulas: Formulas, profile: CamProfile) -> float:
    """(17) to (22) against the curve that the core puts under the follower."""
    phi = (np.arange(2 * _POINTS) + 0.5) / _POINTS * np.pi
    x, y = profile.flanks[0].curve().points(phi).T
    printed = formulas.radius(phi, breadth_of(profile))
    # The point that will touch at φ lies at −φ as the cam stands at its start.
    off = np.hypot(x - printed * np.cos(phi), y + printed * np.sin(phi))
    return float(off.max() / printed.max())


def diameter_difference(formulas: Formulas, profile: CamProfile) -> float:
    """ρ(φ) + ρ(φ + π) by (17) to (22) against b."""
    phi, b = (np.arange(_POINTS) + 0.5) / _POINTS * np.pi, breadth_of(profile)
    apart = formulas.radius(phi, b) + formulas.radius(phi + np.pi, b)
    return float(np.abs(apart - b).max() / b)


def _chain(formulas: Formulas, section: str) -> float:
    """Whether each line of (1) to (3) is the derivative of the line before, by its coefficients."""
    lines = [formulas.polynomial(section, order) for order in range(4)]
    off = [(line.deriv() - after).coef for line, after in pairwise(lines)]
    largest = max(float(np.abs(line.coef).max()) for line in lines)
    return max(float(np.abs(each).max()) for each in off) / largest


def _mirror(formulas: Formulas) -> float:
    """Whether (3) is (1) run through backwards, by its values."""
    u = np.linspace(0.0, 1.0, 101)
    start, stop = formulas.polynomial("start", 0), formulas.polynomial("stop", 0)
    return _share(stop(u), start(1.0) - start(1 - u))


def _joint(formulas: Formulas) -> float:
    """Whether velocity and acceleration pass from (1) to (2) and from (2) to (3) without a step."""
    scale, ends = formulas.speed / formulas.times["start"], np.array([0.0, 1.0])
    steps = []
    for order in (1, 2):
        values = [formulas.over(section, order, ends) for section in SECTIONS]
        steps += [abs(a[1] - b[0]) for a, b in pairwise(values)]
    return float(max(steps) / scale)


def _radius_joint(formulas: Formulas) -> float:
    """Whether (17) meets (18), (18) meets (19), and the two half revolutions meet."""
    ends = np.array([*formulas.branch_begins, np.pi])
    values = [formulas.branch(n, ends[n : n + 2]) for n in range(3)]
    steps = [before[1] - after[0] for before, after in pairwise(values)]
    # The return is the same with the other sign: the forward stroke has to end as far out as it begins in.
    steps.append(values[-1][1] + values[0][0])
    return float(np.abs(steps).max() / formulas.stroke)


def breadth_of(profile: CamProfile) -> float:
    """b of the cam [m]."""
    assert profile.cam.breadth is not None
    return profile.cam.breadth


def _share(found: Floats, printed: Floats) -> float:
    """Largest difference over the largest value."""
    return float(np.abs(found - printed).max() / np.abs(printed).max())
