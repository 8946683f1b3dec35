"""The smallest motor of the catalogue that will do, chosen by checks that analyse the machine with it."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Annotated, Any, Literal

from linkwright.drive.model.catalogue import KNOWN, CatalogueMotor, motors
from linkwright.drive.model.motor import DcMotor, InductionMotor
from linkwright.drive.run_up import RunUp
from linkwright.drive.steady_state import SteadyState
from linkwright.kernel.check import Check
from linkwright.kernel.description.base import suggestion
from linkwright.kernel.errors import FindingError, InputError, MachineError, Problem, show
from linkwright.kernel.public import public
from linkwright.kernel.public.in_range import in_range
from linkwright.kernel.quantities import About, Label
from linkwright.kernel.result import Record
from linkwright.kernel.units.kinds import INERTIA, RATIO
from linkwright.kernel.units.marks import not_negative, positive
from linkwright.machine.machine import Machine
from linkwright.sizing.checks import (
    DECISIVE,
    LEAST_BREAKDOWN,
    LEAST_START,
    MotorChecks,
    motion_checks,
    rating_checks,
)
from linkwright.sizing.flywheel import UNEVENNESS, flywheel_inertia, keeps_flywheel, own_flywheel
from linkwright.sizing.motor_change import rotor_inertia, with_flywheel, with_motor
from linkwright.sizing.power import RequiredPower, required_power

By = Literal["all", "fixed-start", "power"]
Track = Callable[[Sequence[CatalogueMotor]], Iterable[CatalogueMotor]]

ESTIMATE = f"estimated from {KNOWN} by similarity, J as M_rated^(5/3)"

# How far an estimated inertia may be off: types of one frame differ in length only, so that J goes as M and
# not as M^(5/3); over a range of torques of one to three that is a factor of two.
_DOUBT = 2.0

# Of motors of the same power the usual ones have four or six poles, one more or less than this; two poles
# need larger ratios, eight larger motors.
_USUAL_POLES = 5


@dataclass(frozen=True)
class Candidate(Record):
    """One motor and what speaks for and against it."""

    type: Annotated[str, About("Name in the catalogue.")]
    known: Annotated[CatalogueMotor, About("What the catalogue gives.")]
    ratio: Annotated[float, Label("ratio of the gearbox", "", "", "Of the one it would have.")]
    inertia: Annotated[float, Label("inertia of the rotor", "", "kg m²")]
    inertia_estimated: Annotated[bool, About("Whether that is an estimate.")]
    flywheel: Annotated[
        float | None,
        Label(
            "inertia of the flywheel", "", "kg m²", "That it was judged with; None if none was sized for it."
        ),
    ]
    flywheel_kept: Annotated[bool, About("Whether that is the flywheel of the machine.")]
    checks: Annotated[
        tuple[Check, ...], About("Those made; a motor whose rating does not suit is not analysed further.")
    ]
    decisive: Annotated[tuple[str, ...], About("Names of the checks that it must pass.")]
    machine: Annotated[Machine | None, About("The machine with it; None if its rating does not suit.")] = None
    steady: Annotated[SteadyState | None, About("Its steady motion, where there is one.")] = None
    run_up: Annotated[RunUp | None, About("Its run-up, where it succeeds.")] = None

    @property
    def failed(self) -> tuple[Check, ...]:
        """Decisive checks that fail or cannot be made."""
        return tuple(check for check in self.checks if check.name in self.decisive and not check.passed)

    @property
    def passes(self) -> bool:
        """Whether all decisive checks were made and are passed."""
        return not self.failed and {check.name for check in self.checks} >= set(self.decisive)

    @property
    def reason(self) -> str:
        """Why it is refused; empty if it passes."""
        return "; ".join(check.words for check in self.failed)

    @property
    def open(self) -> tuple[Check, ...]:
        """Checks that do not decide and are not passed."""
        return tuple(check for check in self.checks if check.name not in self.decisive and not check.passed)

    @property
    def worst(self) -> Annotated[float, Label("maximum utilisation", "", "")]:
        """Among the decisive checks; infinite where one has no number."""
        shares = [check.utilisation for check in self.failed]
        return max((float("inf") if share is None else share for share in shares), default=0.0)

    def to_dict(self) -> dict[str, Any]:
        """Its entries, ready for JSON."""
        return {
            "type": self.type,
            "power_rated": self.known.power_rated,
            "torque_rated": self.known.torque_rated,
            "ratio": self.ratio,
            "inertia": self.inertia,
            "inertia_estimated": self.inertia_estimated,
            "torque_breakdown": self.known.breakdown,
            "torque_breakdown_is_minimum": self.known.breakdown_is_minimum,
            "torque_start": self.known.start.get("torque_start"),
            "torque_start_is_minimum": self.known.start_is_minimum,
            "flywheel": self.flywheel,
            "flywheel_kept": self.flywheel_kept,
            "passes": self.passes,
            "reason": self.reason,
            "checks": [check.to_dict() for check in self.checks],
            "steady_state": self.steady.to_dict() if self.steady else None,
            "run_up": self.run_up.to_dict() if self.run_up else None,
        }


_MOTOR_CHOICE_PRESENT = "The checks of the motor that the machine has; empty if it has none of this kind."


@dataclass(frozen=True)
class MotorChoice(Record):
    """The choice of a motor."""

    required: Annotated[RequiredPower, About("Power of the loads.")]
    reserve: Annotated[float, Label("rated power over required power", "", "", "As required.")]
    by: Annotated[By, About('``"all"`` checks, ``"fixed-start"``, or ``"power"`` and start alone.')]
    candidates: Annotated[
        tuple[Candidate, ...],
        About("All types of the catalogue, those that pass first, then by rated power."),
    ]
    chosen: Annotated[Candidate | None, About("The smallest that passes.")]
    present: Annotated[tuple[Check, ...], About(_MOTOR_CHOICE_PRESENT)]
    warnings: Annotated[tuple[str, ...], About("Basis of the choice.")]

    @property
    def reason(self) -> str:
        """Why this one, or by how much the best of the catalogue falls short."""
        if self.chosen is None:
            return self._shortfall()
        checks = "all decisive checks" if self.chosen.open else "all checks"
        rule = {
            "all": f"passes {checks}",
            "fixed-start": f"passes {checks} if the machine starts from its start angle",
            "power": "has sufficient power and starts the machine",
        }[self.by]
        power = self.chosen.known.power_rated / 1e3
        return f"{self.chosen.type}, {power:.4g} kW, is the smallest motor of the catalogue that {rule}"

    @property
    def decided_by(self) -> tuple[Check, Candidate] | None:
        """The check without which the smallest motor would pass, and that motor; None if there is none."""
        if self.chosen is None:
            return None
        power = self.chosen.known.power_rated
        near = [
            candidate
            for candidate in self.candidates
            if len(candidate.failed) == 1
            and candidate.known.power_rated < power
            and {check.name for check in candidate.checks} >= set(candidate.decisive)
        ]
        if not near:
            return None
        least = min(near, key=_rank)
        return least.failed[0], least

    def _shortfall(self) -> str:
        need = self.required.power * self.reserve
        suited = [candidate for candidate in self.candidates if candidate.checks[0].passed]
        if not suited:
            ratios = sorted(
                candidate.known.speed_rated / self.required.speed for candidate in self.candidates
            )
            return (
                f"no motor of the catalogue suits the ratio at {self.required.speed:.4g} rad/s: ratios from "
                f"{ratios[0]:.3g} to {ratios[-1]:.3g} would, see free_ratio"
            )
        best = min(suited, key=lambda candidate: (candidate.worst, abs(candidate.known.power_rated - need)))
        return (
            f"no motor of the catalogue suffices: {need / 1e3:.4g} kW are needed; the nearest, {best.type} "
            f"({best.known.power_rated / 1e3:.4g} kW), is refused: {best.reason}"
        )

    def to_dict(self) -> dict[str, Any]:
        """Its entries, ready for JSON."""
        return {
            "chosen": self.chosen.to_dict() if self.chosen else None,
            "reason": self.reason,
            "by": self.by,
            "decided_by": self.decided_by[0].name if self.decided_by else None,
            "power_reserve": self.reserve,
            "present": [check.to_dict() for check in self.present],
            "considered": [
                candidate.to_dict() for candidate in self.candidates if candidate is not self.chosen
            ],
        }


@public
def choose_motor(
    machine: Machine,
    *,
    reserve: float = 1.1,
    by: By = "all",
    free_ratio: bool = False,
    unevenness: float | None = None,
    together: bool = True,
    inertias: Mapping[str, float] | None = None,
    catalogue: Sequence[CatalogueMotor] | None = None,
    track: Track = iter,
) -> MotorChoice:
    """Choose the smallest motor of the catalogue that passes the checks.

    Parameters
    ----------
    machine : Machine
        The machine, with ``drive.speed``; its own motor, if it has one, does not count.
    reserve : float
        Rated power over required power that is asked for [–].
    by : str
        ``"all"``: every check decides. ``"fixed-start"``: every one but the start from the worst angle, for a
        machine that is always started from its start angle. ``"power"``: rated power and start alone, as is
        often done.
    free_ratio : bool
        Give each motor the ratio that suits it, rated speed over design speed, not the machine's own. So it
        is done in any case if the machine has no gearbox.
    unevenness : float, optional
        Judge each motor together with the flywheel on the crankshaft that gives this δ with it [–]. It takes
        the peaks off the motor, so that a smaller one may do. Where the machine's own flywheel gives it too,
        either may serve.
    together : bool
        With `unevenness`: whether that flywheel may help. If not, the motor must also pass the checks on the
        machine as it is, whose flywheel is then kept where it suffices.
    inertias : mapping, optional
        Type → inertia of its rotor [kg m²], where it is known better than the catalogue does.
    catalogue : sequence of CatalogueMotor, optional
        Types to choose from, such as those of `read_motors`, also DC and servo motors; by default `motors`.
    track : callable, optional
        Takes the types and gives them back one by one, to show how far it is.

    Returns
    -------
    MotorChoice
        The motor, the machine with it and its analyses, and why the others are refused.

    Raises
    ------
    InputError
        No design speed, no load to size for, a reserve that is not positive, an unknown type.
    AssemblyError
        The mechanism does not close all round.

    References
    ----------
    .. [1] Paper 1: required power, then a motor of the catalogue.
    """
    in_range(
        reserve=(reserve, positive(RATIO)),
        unevenness=(unevenness, UNEVENNESS),
        **{f"inertias of {type}": (J, not_negative(INERTIA)) for type, J in (inertias or {}).items()},
    )
    required = required_power(machine)
    if not required.power > 0:
        from linkwright.kernel.reader.numbers import quantity

        raise InputError(
            f"the mean load at the crank is {quantity(required.torque_load_mean, 'N m')}: there is no "
            "motor to size for it; --keep-motor sizes the flywheel alone"
        )
    types = motors() if catalogue is None else tuple(catalogue)
    if not types:
        raise InputError("catalogue: found no motor to choose from")
    given = own_inertia(machine) | {_of(type, types).type: J for type, J in (inertias or {}).items()}
    is_free = free_ratio or not _has_ratio(machine)
    judge = _Judge(machine, required, reserve, by, is_free, unevenness, together, given)
    candidates = sorted((judge.candidate(known) for known in track(types)), key=_rank)
    chosen = candidates[0] if candidates[0].passes else None
    present = present_checks(machine, required, reserve)
    warnings = (*judge.doubts(chosen), *_smaller(candidates, chosen, by))
    return MotorChoice(required, reserve, by, tuple(candidates), chosen, present, warnings)


def _smaller(candidates: Sequence[Candidate], chosen: Candidate | None, by: By) -> list[str]:
    """The smaller motor that would suffice without a start from the worst angle."""
    if by != "all":
        return []
    would = [replace(candidate, decisive=DECISIVE["fixed-start"]) for candidate in candidates]
    least = min((candidate for candidate in would if candidate.passes), key=_rank, default=None)
    if least is None or (chosen and least.known.power_rated >= chosen.known.power_rated):
        return []
    power = least.known.power_rated / 1e3
    return [
        f"for a start from the start angle only, {least.type} of {power:.4g} kW suffices: see fixed-start"
    ]


def _of(type: str, types: Sequence[CatalogueMotor]) -> CatalogueMotor:
    by_name = {known.type: known for known in types}
    if type not in by_name:
        expected, remedy = "a type of the catalogue of motors", suggestion(type, by_name)
        raise MachineError([Problem(found=show(type), expected=expected, remedy=remedy)])
    return by_name[type]


def own_inertia(machine: Machine) -> dict[str, float]:
    """The rotor's inertia that the machine gives for a type of the catalogue, by type."""
    motor = machine.drive.motor if machine.drive else None
    if isinstance(motor, InductionMotor) and motor.catalogue and "inertia" in motor.model_fields_set:
        return {motor.catalogue: motor.inertia}
    return {}


def present_checks(machine: Machine, required: RequiredPower, reserve: float) -> tuple[Check, ...]:
    """The checks of the machine's own motor; empty without an induction or DC motor of known rated point."""
    motor = machine.drive.motor if machine.drive else None
    if not isinstance(motor, InductionMotor | DcMotor) or None in (motor.power_rated, motor.speed_rated):
        return ()
    assert machine.drive is not None
    assert motor.power_rated is not None
    assert motor.speed_rated is not None
    rated = CatalogueMotor("", "", 0, 0.0, motor.power_rated, motor.speed_rated, motor.torque_rated or 0.0)
    rating = rating_checks(rated, machine.drive.gearbox.ratio, required, reserve)
    return (*rating, *motion_checks(machine).checks)


def _has_ratio(machine: Machine) -> bool:
    return machine.drive is not None and "ratio" in machine.drive.gearbox.model_fields_set


def _rank(candidate: Candidate) -> tuple[bool, float, bool, str]:
    """Rank: passing motors first, then smaller ones, of these the ones with four or six poles."""
    known = candidate.known
    return not candidate.passes, known.power_rated, abs(known.poles - _USUAL_POLES) > 1, candidate.type


def _least_torques(known: CatalogueMotor) -> Iterator[str]:
    if known.breakdown_is_minimum:
        yield f"the breakdown torque of {known.type}, {known.breakdown:.4g} N m, is {LEAST_BREAKDOWN}"
    if known.start_is_minimum:
        yield f"the starting torque of {known.type}, {known.start['torque_start']:.4g} N m, is {LEAST_START}"


@dataclass(frozen=True)
class _Fit:
    """A machine with a motor, its checks, and the flywheel on the crankshaft in these."""

    machine: Machine | None
    done: MotorChecks
    flywheel: float | None = None  # [kg m²]
    kept: bool = False  # whether it is the machine's own


@dataclass(frozen=True)
class _Judge:
    machine: Machine
    required: RequiredPower
    reserve: float
    by: By
    free_ratio: bool
    unevenness: float | None
    together: bool
    inertias: Mapping[str, float]

    def candidate(self, known: CatalogueMotor) -> Candidate:
        """One type with its checks; its motion is analysed only if its rating suits."""
        assert self.machine.drive is not None
        most = known.speed_rated if known.speed_max is None else min(known.speed_rated, known.speed_max)
        free = most / self.required.speed
        ratio = free if self.free_ratio else self.machine.drive.gearbox.ratio
        rating = rating_checks(known, ratio, self.required, self.reserve)
        estimate, estimated = rotor_inertia(known)
        inertia = self.inertias.get(known.type, estimate)
        estimated = estimated and known.type not in self.inertias
        fitted = _Fit(None, MotorChecks(()))
        if all(check.passed for check in rating):
            fitted = self._analysed(known, inertia, ratio, estimated)
        return Candidate(
            type=known.type,
            known=known,
            ratio=ratio,
            inertia=inertia,
            inertia_estimated=estimated,
            flywheel=fitted.flywheel,
            flywheel_kept=fitted.kept,
            checks=(*rating, *fitted.done.checks),
            decisive=DECISIVE[self.by],
            machine=fitted.machine,
            steady=fitted.done.steady,
            run_up=fitted.done.run_up,
        )

    def _analysed(self, known: CatalogueMotor, inertia: float, ratio: float, estimated: bool) -> _Fit:
        note = f"Motor {known.type} by linkwright size"
        note += f"; the inertia of its rotor is {ESTIMATE}." if estimated else "."
        machine = with_motor(self.machine, known, inertia=inertia, ratio=ratio, note=note)
        if self.unevenness is None:
            return _Fit(machine, motion_checks(machine, known))
        if self.together:
            sized = self._with_flywheel(machine, known)
            if not self._failed(sized.done) or not keeps_flywheel(machine, self.unevenness):
                return sized
            own = _Fit(machine, motion_checks(machine, known), own_flywheel(machine), kept=True)
            return min(sized, own, key=lambda fitted: len(self._failed(fitted.done)))
        alone = _Fit(machine, motion_checks(machine, known))
        if self._failed(alone.done):
            return alone
        if keeps_flywheel(machine, self.unevenness):
            return replace(alone, flywheel=own_flywheel(machine), kept=True)
        return self._with_flywheel(machine, known)

    def _with_flywheel(self, machine: Machine, known: CatalogueMotor) -> _Fit:
        assert self.unevenness is not None
        try:
            flywheel, _ = flywheel_inertia(with_flywheel(machine, 0.0), self.unevenness)
        except FindingError as error:
            lost = Check("run_up", None, None, "s", False, note=str(error))
            return _Fit(machine, MotorChecks((lost,)))
        fitted = with_flywheel(machine, flywheel)
        return _Fit(fitted, motion_checks(fitted, known), flywheel)

    def _failed(self, done: MotorChecks) -> list[str]:
        passed = {check.name for check in done.checks if check.passed}
        return [name for name in DECISIVE[self.by][2:] if name not in passed]

    def doubts(self, chosen: Candidate | None) -> list[str]:
        if chosen is None:
            return []
        return [*_least_torques(chosen.known), *self._rotor(chosen)]

    def _rotor(self, chosen: Candidate) -> list[str]:
        if not chosen.inertia_estimated:
            return []
        words = f"the inertia of the rotor of {chosen.type}, {chosen.inertia:.3g} kg m², is {ESTIMATE}"
        lost = [name for factor in (1 / _DOUBT, _DOUBT) for name in self._lost(chosen, factor)]
        if lost:
            names = ", ".join(dict.fromkeys(lost)).replace("_", " ")
            return [f"{words}; with half or twice this value the motor does not pass: {names}"]
        return [f"{words}; with half or twice this value the motor also passes"]

    def _lost(self, chosen: Candidate, factor: float) -> list[str]:
        inertia = chosen.inertia * factor
        checks = self._analysed(chosen.known, inertia, chosen.ratio, True).done.checks
        return [check.name for check in checks if check.name in chosen.decisive and not check.passed]
