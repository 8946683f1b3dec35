"""Function generation: a four-bar linkage whose rocker turns with y(x) while its crank turns with x.

Both scales are linear: φ = φ₀ + Δφ (x − x₀)/(x_n − x₀) and ψ = ψ₀ + Δψ (y − y₀)/(y_n − y₀). The linkage
meets the function at
its precision points; between them it deviates by the structural error, which is found by analysing the
machine again.

Source: F. Freudenstein, Approximate synthesis of four-bar linkages, Transactions of the ASME 77 (1955)
853–861; spacing by Chebyshev: Hartenberg, Denavit, Kinematic Synthesis of Linkages, 1964.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Annotated

import numpy as np

from linkwright.kernel.arrays import Floats
from linkwright.kernel.errors import SynthesisError
from linkwright.kernel.public import public
from linkwright.kernel.quantities import About, Label
from linkwright.linkages.kinematics import motions
from linkwright.machine.machine import Machine
from linkwright.synthesis.expression import Scale
from linkwright.synthesis.four_bar import FourBar, side_of
from linkwright.synthesis.freudenstein import EXACT, Fit, lengths, solve
from linkwright.synthesis.function_fit import nearest
from linkwright.synthesis.task import FunctionTask
from linkwright.synthesis.verification import TransmissionResult, require_met

# Starts that end at the minimum error before it counts as the global minimum.
_SURE = 3

SOURCE = "Synthesised by linkwright as a function generator"


_FUNCTION_GENERATOR_MACHINE = "The linkage, its frame along x; crank angle zero is the start of the range."


@dataclass(frozen=True)
class FunctionGenerator(TransmissionResult):
    """A four-bar linkage that generates a function."""

    type: Annotated[str, About("Which links turn fully.")]
    frame: Annotated[float, Label("length of the frame", "", "m")]
    crank: Annotated[float, Label("length of the crank", "", "m")]
    coupler: Annotated[float, Label("length of the coupler", "", "m")]
    rocker: Annotated[float, Label("length of the rocker", "", "m")]
    crank_start: Annotated[
        float, Label("crank angle at the start of the range", "φ_0", "rad", "From the frame.")
    ]
    rocker_start: Annotated[
        float, Label("rocker angle at the start of the range", "ψ_0", "rad", "From the frame.")
    ]
    crank_opposite: Annotated[bool, About("Whether the link ``A`` points against the crank angle.")]
    rocker_opposite: Annotated[bool, About("Whether the link ``B.rocker`` points against the rocker angle.")]
    assembly: Annotated[
        str,
        About("Side of the joint, seen from the crank's pin to the rocker's pivot, as in the machine file."),
    ]
    residual: Annotated[
        float,
        Label(
            "residual of Freudenstein's equation",
            "",
            "",
            "Root of the mean square; 0 where all points are met.",
        ),
    ]
    angle_error_max: Annotated[
        float, Label("maximum structural error", "", "rad", "Of the rocker angle over the range.")
    ]
    angle_error_rms: Annotated[
        float, Label("root-mean-square structural error", "", "rad", "Of the rocker angle over the range.")
    ]
    function_error_max: Annotated[float, About("The maximum in the unit of y.")]
    angle_error_points: Annotated[
        float, Label("maximum error at the points", "", "rad", "Of the rocker angle.")
    ]
    transmission_angle_min: Annotated[
        float, Label("minimum transmission angle", "μ_min", "rad", "Over the range.")
    ]
    solutions: Annotated[
        int, Label("linkages found", "", "", "This is the one with the minimum structural error.")
    ]
    starts: Annotated[int, Label("starts of the search", "", "")]
    found_by: Annotated[int, Label("starts that ended at this linkage", "", "")]
    x: Annotated[Floats, About("Arguments over the range.", "(m,)")]
    wanted: Annotated[Floats, About("The function there.", "(m,)")]
    generated: Annotated[Floats, About("What the machine gives there.", "(m,)")]
    points: Annotated[Floats, About("Arguments of the points.", "(n,)")]
    machine: Annotated[Machine, About(_FUNCTION_GENERATOR_MACHINE)]

    @property
    def warnings(self) -> tuple[str, ...]:
        """What to know of the search and of the linkage."""
        is_search = self.starts > 1 and len(self.points) > 3
        if not is_search or self.found_by >= _SURE:
            return super().warnings
        words = (
            f"only {self.found_by} of {self.starts} starts ended at this linkage: there may be a better one; "
            "give crank_start or rocker_start near the ones found to look there"
        )
        return (words, *super().warnings)


@public
def function_generator(task: FunctionTask) -> FunctionGenerator:
    """Find the four-bar linkage that generates a function.

    Parameters
    ----------
    task : FunctionTask
        The function, its range, its points, and the angles of crank and rocker.

    Returns
    -------
    FunctionGenerator
        Of all linkages that meet the points and can be driven through the range, the one with the minimum
        structural error. More points than unknowns say where the search begins, by least squares of the
        structural error there; then its largest value over the range is minimised.

    Raises
    ------
    InputError
        The function cannot be read, or has no values in its range.
    SynthesisError
        No linkage meets the points, or none can be driven through them.

    References
    ----------
    .. [1] F. Freudenstein, Approximate synthesis of four-bar linkages, Transactions of the ASME 77 (1955)
    853–861.
    """
    scale = Scale.of(task)
    exact = len(scale.points) == task.unknowns
    if exact:
        fits, n_starts = solve(scale.crank, scale.rocker, task.crank_start, task.rocker_start)
    else:
        fits, n_starts = nearest(task, scale)
    if not fits:
        raise SynthesisError(_no_solution(task, scale, n_starts, exact=exact))
    results, reasons = _usable(task, scale, fits)
    if not results:
        raise SynthesisError(_none(fits, reasons))
    best = min(results, key=lambda fit: fit.angle_error_max)
    return FunctionGenerator(**{**vars(best), "solutions": len(results), "starts": n_starts})


def _no_solution(task: FunctionTask, scale: Scale, n_starts: int, *, exact: bool) -> str:
    n = len(scale.points)
    if exact:
        return (
            f"no linkage meets the {n} points: Freudenstein's equation has no real solution for them; change "
            "crank_range or rocker_range, or give fewer points"
        )
    return (
        f"none of {n_starts} starts ended at a linkage that keeps all limits over the range "
        f"(length_ratio_max {task.length_ratio_max:g}, transmission angle at least "
        f"{np.degrees(task.transmission_angle_min):.4g}°); raise length_ratio_max, lower "
        "transmission_angle_min, change crank_range or rocker_range"
    )


def _usable(task: FunctionTask, scale: Scale, fits: list[Fit]) -> tuple[list[FunctionGenerator], list[str]]:
    """Results of the solutions that keep all limits, and why the others do not."""
    results: list[FunctionGenerator] = []
    reasons: list[str] = []
    for fit in fits:
        try:
            results.append(_generator(task, scale, fit))
        except SynthesisError as reason:
            reasons.append(str(reason))
    return results, reasons


def _generator(task: FunctionTask, scale: Scale, fit: Fit) -> FunctionGenerator:
    """The result of one solution; a finding if it cannot be driven through the range."""
    sides = lengths(fit.K, task.frame)
    if sides is None:
        raise SynthesisError("its coupler would have an imaginary length")
    r, c, b = sides
    size = (task.frame, abs(r), c, abs(b))
    if max(size) > task.length_ratio_max * min(size):
        ratio = max(size) / min(size)
        raise SynthesisError(
            f"its longest link is {ratio:.4g} times its shortest (length_ratio_max {task.length_ratio_max:g})"
        )
    bar = _bar(task, scale, fit, r, c, b)
    mu = float(bar.transmission_angle(scale.crank_over).min())
    if (bar.gap(scale.crank_over) < 0).any():
        raise SynthesisError(f"as a {bar.type} it does not close over the whole range")
    if mu < task.transmission_angle_min:
        raise SynthesisError(
            f"its transmission angle falls to {np.degrees(mu):.2f}° (transmission_angle_min "
            f"{np.degrees(task.transmission_angle_min):.4g}°)"
        )
    name = task.name or f"Function generator, {task.function or 'table'}"
    made = _analysed(scale, fit, bar, bar.machine(name, source=SOURCE), (r < 0, b < 0), mu)
    if len(scale.points) == task.unknowns:
        # As many points as unknowns are met exactly.
        require_met("an error at its points", 0.0, made.angle_error_points, "rad", size=1.0)
    return made


def _bar(task: FunctionTask, scale: Scale, fit: Fit, r: float, c: float, b: float) -> FourBar:
    frame = task.frame
    pins = r * np.exp(1j * (fit.crank_start + scale.crank))
    joints = frame + b * np.exp(1j * (fit.rocker_start + scale.rocker))
    sides = {side_of(a, frame + 0j, joint) for a, joint in zip(pins, joints, strict=True)}
    if len(sides) > 1:
        raise SynthesisError("its points lie on different branches")
    phase = fit.crank_start + (np.pi if r < 0 else 0.0)
    return FourBar(0j, complex(frame), abs(r), c, abs(b), sides.pop(), float(phase))


def _analysed(
    scale: Scale, fit: Fit, bar: FourBar, machine: Machine, opposite: tuple[bool, bool], mu: float
) -> FunctionGenerator:
    """The machine analysed again over the range and at the points; `opposite`: crank and rocker."""
    start = fit.rocker_start + (np.pi if opposite[1] else 0.0)
    over = _rocker_angles(machine, scale.crank_over) - start
    errors = np.angle(np.exp(1j * (over - scale.rocker_over)))
    at_points = _rocker_angles(machine, scale.crank) - start - scale.rocker
    return FunctionGenerator(
        type=bar.type,
        frame=float(bar.frame),
        crank=float(bar.crank),
        coupler=float(bar.coupler),
        rocker=float(bar.rocker),
        crank_start=fit.crank_start,
        rocker_start=fit.rocker_start,
        crank_opposite=bool(opposite[0]),
        rocker_opposite=bool(opposite[1]),
        assembly=bar.assembly,
        residual=fit.residual if fit.residual > EXACT else 0.0,
        angle_error_max=float(np.abs(errors).max()),
        angle_error_rms=float(np.sqrt(np.mean(errors**2))),
        function_error_max=float(np.abs(errors).max() * abs(scale.per_angle)),
        angle_error_points=float(np.abs(np.angle(np.exp(1j * at_points))).max()),
        transmission_angle_min=mu,
        solutions=1,
        starts=1,
        found_by=fit.found_by,
        x=scale.x,
        wanted=scale.wanted,
        generated=scale.wanted + errors * scale.per_angle,
        points=scale.points,
        machine=machine,
    )


def _rocker_angles(machine: Machine, angles: Floats) -> Floats:
    table = motions(machine, angles, links=["B.rocker"])[0]
    return np.asarray(np.arctan2(table[1], table[0]))


def _none(fits: list[Fit], reasons: list[str]) -> str:
    """Why none of the solutions can be used, the commonest reason with its numbers first."""
    causes = "; ".join(dict.fromkeys(reasons[:3]))
    n = f"{len(fits)} solution{'s' if len(fits) > 1 else ''}"
    return (
        f"Freudenstein's equation has {n}, none of which can be used: {causes}. Change crank_range, "
        "rocker_range or the start angles"
    )
