"""Dead-centre design of a slider-crank: a wanted stroke and time ratio, by the triangle of `dead_centre`.

The chord h is the stroke, and the guide passes the crank's pivot at the height of the triangle, e = p q |sin
δ|/h. The transmission angle between the rod and the normal of the guide is smallest where the pin is farthest
from the guide, cos μ = (r + e)/c.

Source: VDI 2130; Volmer, Getriebetechnik: Koppelgetriebe.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Annotated, ClassVar

import numpy as np

from linkwright.kernel.arrays import Floats
from linkwright.kernel.errors import InputError, SynthesisError
from linkwright.kernel.public import public
from linkwright.kernel.public.in_range import in_range
from linkwright.kernel.quantities import About, Label
from linkwright.kernel.units.kinds import LENGTH, RATIO
from linkwright.kernel.units.marks import positive
from linkwright.machine.machine import Machine
from linkwright.synthesis.dead_centre import SOURCE, best, delta_of, joints, slow_over_quick
from linkwright.synthesis.four_bar import cross, machine_of
from linkwright.synthesis.verification import (
    TransmissionResult,
    element_of,
    require_met,
    require_transmission,
)


@dataclass(frozen=True)
class StrokeCrank(TransmissionResult):
    """A slider-crank for a given stroke and time ratio."""

    remedy: ClassVar[str] = "give a longer rod, or a time ratio nearer to 1"

    stroke: Annotated[float, Label("stroke of the slider", "s", "m", "Between the dead centres.")]
    crank_angle_forward: Annotated[
        float,
        Label("crank angle of the forward stroke", "φ₀", "rad", "From the outer dead centre to the inner."),
    ]
    time_ratio: Annotated[float, Label("time ratio", "", "", "φ₀ over the rest of the revolution.")]
    crank: Annotated[float, Label("radius of the crank", "r", "m")]
    rod: Annotated[float, Label("length of the rod", "l", "m")]
    offset: Annotated[float, Label("offset of the guide", "e", "m")]
    transmission_angle_min: Annotated[
        float,
        Label("minimum transmission angle", "μ_min", "rad", "Between the rod and the normal of the guide."),
    ]
    crank_angle_outer: Annotated[
        float, Label("crank angle of the outer dead centre", "", "rad", "In the machine.")
    ]
    crank_angle_inner: Annotated[
        float, Label("crank angle of the inner dead centre", "", "rad", "In the machine.")
    ]
    machine: Annotated[Machine, About("The linkage, its guide along x.")]


@public
def slider_crank(stroke: float, time_ratio: float = 1.0, *, rod: float | None = None) -> StrokeCrank:
    """Find the slider-crank for a stroke and a time ratio.

    Parameters
    ----------
    stroke : float
        Way of the slider between its dead centres [m].
    time_ratio : float
        Crank angle from the outer dead centre to the inner one over the rest of the revolution [–].
    rod : float, optional
        Its rod [m]. Default: the rod of the best transmission angle; at a time ratio of 1 there is none.

    Returns
    -------
    StrokeCrank
        The linkage. Its crank turns counter-clockwise.

    Raises
    ------
    InputError
        A stroke, time ratio or rod that is not positive, or no rod at a time ratio of 1.
    SynthesisError
        No slider-crank has this stroke, time ratio and rod, or none that keeps them when analysed again.

    References
    ----------
    .. [1] VDI 2130.
    """
    in_range(
        stroke=(stroke, positive(LENGTH)),
        time_ratio=(time_ratio, positive(RATIO)),
        rod=(rod, positive(LENGTH)),
    )
    delta = delta_of(time_ratio)
    if rod is None and delta == 0:
        raise InputError(
            "with a time ratio of 1 the rod is free, and longer is better: give the rod, such as 3 to 5 "
            f"times half the stroke ({3 * stroke / 2:.4g} m to {5 * stroke / 2:.4g} m)"
        )
    t, mu = best(lambda t: _slide_transmission(t, delta), float(np.sin(abs(delta) / 2)))
    if rod is not None:
        t = stroke / (2 * rod)
        mu = float(_slide_transmission(np.array([t]), delta)[0]) if np.sin(abs(delta) / 2) < t < 1 else np.nan
    if not mu > 0:
        raise SynthesisError(_no_slider_crank(stroke, time_ratio, rod, delta))
    return _verified(_stroke_crank(stroke, time_ratio, delta, t, mu))


def _verified(made: StrokeCrank) -> StrokeCrank:
    element = element_of(made.machine, "B")
    require_met("a stroke", made.stroke, element.stroke, "m")
    require_met("a time ratio", *slow_over_quick(made.time_ratio, element.time_ratio))
    require_transmission(made.transmission_angle_min, element)
    return made


def _slide_transmission(t: Floats, delta: float) -> Floats:
    """Minimum transmission angle of a slider-crank in its revolution; NaN where its crank does not turn."""
    crank, coupler, outer, inner = joints(t, delta)
    offset = np.abs(cross(outer, inner)) / np.abs(outer - inner)
    ahead = np.real(np.conj(outer - inner) * inner) > 0
    good = ahead & (coupler > crank + offset) & (crank > 0)
    with np.errstate(invalid="ignore"):
        return np.where(good, np.arccos((crank + offset) / coupler), np.nan)


def _stroke_crank(stroke: float, time_ratio: float, delta: float, t: float, mu: float) -> StrokeCrank:
    crank, rod, outer, inner = (0.5 * stroke * joint[0] for joint in joints(np.array([t]), delta))
    along = (outer - inner) / abs(outer - inner)
    outer, inner = outer / along, inner / along
    offset = float(outer.imag)
    slider = {"crank": "A", "rod": float(rod), "offset": offset}
    mechanism = {"cranks": {"A": {"radius": float(crank)}}, "sliders": {"B": slider}}
    name = f"Slider-crank, stroke {stroke:.6g} m, time ratio {time_ratio:.6g}"
    return StrokeCrank(
        stroke=float(stroke),
        crank_angle_forward=float(np.pi + delta),
        time_ratio=float(time_ratio),
        crank=float(crank),
        rod=float(rod),
        offset=offset,
        transmission_angle_min=float(mu),
        crank_angle_outer=float(np.angle(outer)) % (2 * np.pi),
        crank_angle_inner=float(np.angle(-inner)) % (2 * np.pi),
        machine=machine_of(name, mechanism, SOURCE),
    )


def _no_slider_crank(stroke: float, time_ratio: float, rod: float | None, delta: float) -> str:
    least, most = stroke / 2, stroke / 2 / np.sin(abs(delta) / 2) if delta else np.inf
    what = f"no slider-crank has a stroke of {stroke:.4g} m, a time ratio of {time_ratio:.4g}"
    limits = f"lie between {least:.4g} m and {most:.4g} m" if delta else f"be longer than {least:.4g} m"
    if rod is None:
        return f"{what} and a crank that turns: bring the time ratio nearer to 1"
    return (
        f"{what} and a rod of {rod:.4g} m: the rod must {limits}, and its crank must turn; change the rod, "
        "or bring the time ratio nearer to 1"
    )
