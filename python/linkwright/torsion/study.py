"""Everything about the torsional vibration of a train, for a report or as one object."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field, fields
from typing import TYPE_CHECKING, Any

import numpy as np

from linkwright.kernel.errors import FindingError, InputError, show
from linkwright.kernel.public import public
from linkwright.kernel.public.in_range import in_range
from linkwright.kernel.result import PlainRecord, Result
from linkwright.kernel.units.kinds import FREQUENCY
from linkwright.kernel.units.marks import not_negative
from linkwright.machine.machine import Machine
from linkwright.torsion.excitation.drive_line import train_of
from linkwright.torsion.excitation.engine_torques import EngineData, engine_data
from linkwright.torsion.excitation.excited_train import ExcitedTrain, excited_train, is_excited, pulsates
from linkwright.torsion.in_time.transient import TorsionTransient, torsion_transient
from linkwright.torsion.limits.crank_fatigue import CrankshaftFatigue, surveyed_fatigue
from linkwright.torsion.limits.criteria import swing
from linkwright.torsion.limits.critical_response import CriticalResponse, critical_responses
from linkwright.torsion.limits.misfire import MisfireVerdict, misfire_verdict
from linkwright.torsion.limits.overlay import Overlay, overlay
from linkwright.torsion.limits.survey import TorquePeaks, between, survey, torque_peaks
from linkwright.torsion.limits.verdict import Verdict, operation, verdict
from linkwright.torsion.model.engine.engine import firing_angles
from linkwright.torsion.model.engine.throw_compliance import compliance_remarks
from linkwright.torsion.model.measured_response import MeasuredResponse
from linkwright.torsion.model.train import Train
from linkwright.torsion.modes.campbell import CampbellDiagram, campbell
from linkwright.torsion.modes.damped import DampedVibration, damped_vibration
from linkwright.torsion.modes.free import FreeVibration, ShaftShapes, free_vibration
from linkwright.torsion.modes.holzer import HolzerTable, holzer_frequency, holzer_table
from linkwright.torsion.modes.phase_vectors import PhaseVectors, phase_vectors
from linkwright.torsion.modes.scheme import Scheme, scheme
from linkwright.torsion.response.forced import ForcedVibration, responded
from linkwright.torsion.response.mesh_torque import MeshTorque, meshed
from linkwright.torsion.response.speed_control import limited_controllers
from linkwright.torsion.response.stress import ShaftStress, shaft_stress
from linkwright.torsion.response.unevenness_along import UnevennessAlong, unevenness_along

if TYPE_CHECKING:
    from matplotlib.figure import Figure

# Share by which loads may be off what the engine gives without a word.
_FITS = 0.1

# Share by which loads that follow an engine are as they are given.
_BALANCED = 1e-3

# Share of a limit from which on it matters that more may be asked for beyond the speeds.
_NEAR = 0.8

# Swing of a pendulum beyond which linear vibration misleads [rad]: its period grows by ψ²/16, here 1.6 %.
_LARGE_SWING = 0.5


@dataclass(frozen=True)
class TorsionStudy(PlainRecord):
    """Torsional vibration of a machine, as far as it has any.

    Attributes
    ----------
    machine : Machine
    scheme : Scheme
        Its equivalent scheme, referred to one speed.
    free : FreeVibration
        Natural frequencies and shapes.
    holzer : tuple of HolzerTable
        At the frequencies asked for.
    damped : DampedVibration or None
        The same with damping; None where nothing damps it.
    excited : ExcitedTrain or None
        Its torques; None where nothing excites it.
    forced : ForcedVibration or None
        Its vibration under them.
    stress : ShaftStress or None
        Of the shafts with known sections.
    verdict : Verdict or None
        Whether all limits are kept.
    misfire : MisfireVerdict or None
        The same with the worst single misfire of an engine.
    along : UnevennessAlong or None
        Speed fluctuation over the cylinders of an engine at its speed of service.
    engines : dict of EngineData
        What each engine is in the train, by name; that of a single one is empty.
    campbell : CampbellDiagram or None
        Critical speeds.
    peaks : TorquePeaks or None
        Largest torques of the shafts, resonances between the speeds among them.
    transient : TorsionTransient or None
        The manoeuvre of [train.transient].
    meshes : MeshTorque or None
        Torques of the gear stages; None without any.
    stars : tuple of PhaseVectors
        Phase vectors of the orders at the critical speeds.
    critical_holzer : tuple of HolzerTable
        At the natural frequencies that an order meets among the speeds.
    overlays : tuple of Overlay
        Measured curves over the computed ones.
    fatigue : tuple of CrankshaftFatigue
        Of the crankshafts whose fillets and steel are known.
    critical_responses : tuple of CriticalResponse
        Synthesis of the orders at the critical speeds, where forced response peaks.
    """

    machine: Machine
    scheme: Scheme
    free: FreeVibration
    holzer: tuple[HolzerTable, ...]
    damped: DampedVibration | None = None
    excited: ExcitedTrain | None = None
    forced: ForcedVibration | None = None
    stress: ShaftStress | None = None
    verdict: Verdict | None = None
    misfire: MisfireVerdict | None = None
    along: UnevennessAlong | None = None
    engines: Mapping[str, EngineData] = field(default_factory=dict)
    campbell: CampbellDiagram | None = None
    peaks: TorquePeaks | None = None
    transient: TorsionTransient | None = None
    meshes: MeshTorque | None = None
    stars: tuple[PhaseVectors, ...] = ()
    critical_holzer: tuple[HolzerTable, ...] = ()
    overlays: tuple[Overlay, ...] = ()
    critical_responses: tuple[CriticalResponse, ...] = ()
    fatigue: tuple[CrankshaftFatigue, ...] = ()

    @property
    def engine(self) -> EngineData | None:
        """The engine of a train that has but one."""
        return self.engines.get("")

    @property
    def findings(self) -> list[str]:
        """What the machine does not bear, in sentences."""
        judgements = [] if self.verdict is None else self.verdict.judgements
        steady = [f"{judgement.words}." for judgement in judgements if judgement.state == "exceeds"]
        weak = (one for one in self.fatigue if not one.is_acceptable and not one.outside)
        steady += [f"{one.words}." for one in weak]
        return steady + ([] if self.transient is None else self.transient.findings)

    @property
    def operation(self) -> str:
        """How the train may be operated in continuous operation, in sentences; empty without limits."""
        if self.verdict is None or self.forced is None:
            return ""
        speeds = self.forced.speeds
        weak = [f"{one.words}." for one in self.fatigue if not one.is_acceptable]
        words = operation((float(speeds[0]), float(speeds[-1])), self.verdict, self.misfire)
        return " ".join([*weak, words]).strip()

    @property
    def balance(self) -> str:
        """What counts other than the file says so that mean torques balance; empty where nothing does."""
        return " ".join(_balance(self))

    @property
    def warnings(self) -> list[str]:
        """What the numbers leave out, in sentences."""
        return list(_warnings(self))

    @public
    def plot(self, name: str = "scheme") -> Figure:
        """A figure of the report: ``"scheme"``, ``"mode_shapes"``, and others that the study has.

        Parameters
        ----------
        name : str
            Of the figure.

        Returns
        -------
        matplotlib.figure.Figure
            A notebook shows it; ``figure.savefig(path)`` writes it.

        Raises
        ------
        InputError
            There is no such figure; the message lists all.
        """
        from linkwright.kernel.figure.figure_of import plotted_figure

        return plotted_figure(self, name)

    def _repr_html_(self) -> str:
        from linkwright.kernel.page.notebook import study_html

        parts = {entry.name: getattr(self, entry.name) for entry in fields(self)}
        return study_html(self, {name: part for name, part in parts.items() if isinstance(part, Result)})

    def results(self) -> dict[str, Any]:
        """Results by name, ready for JSON but for numbers that it does not know."""
        free = self.free.to_dict(curves=True)
        free["nodes"] = [[node._asdict() for node in nodes] for nodes in self.free.nodes]
        free["along"] = [_listed(shapes) for shapes in self.free.along]
        results: dict[str, Any] = {"free": free}
        if self.holzer:
            results["holzer"] = [table.to_dict(curves=True) for table in self.holzer]
        if self.damped is not None:
            results["damped"] = self.damped.to_dict(curves=True)
        parts: dict[str, Result | None] = {
            "forced": self.forced,
            "peaks": self.peaks,
            "stress": self.stress,
            "verdict": self.verdict,
        }
        parts |= {"misfire": self.misfire}
        results |= {name: part.to_dict(curves=True) for name, part in parts.items() if part is not None}
        if self.transient is not None:
            results["transient"] = self.transient.to_dict()
        if self.campbell is not None:
            results["campbell"] = self.campbell.to_dict()
        if self.engine is not None:
            results["engine"] = self.engine.to_dict()
        elif self.engines:
            results["engines"] = {name: engine.to_dict() for name, engine in self.engines.items()}
        if self.meshes is not None:
            results["gears"] = self.meshes.to_dict()
        if self.stars:
            results["phase_vectors"] = [star.to_dict() for star in self.stars]
        if self.fatigue:
            results["fatigue"] = [one.to_dict() for one in self.fatigue]
        if self.operation:
            results["operation"] = self.operation
        if self.critical_responses:
            results["critical_responses"] = [
                one.to_dict() | {"kind": one.kind.unit} for one in self.critical_responses
            ]
        if self.overlays:
            results["measured"] = [one.to_dict() for one in self.overlays]
        if self.along is not None:
            results["unevenness_along"] = self.along.to_dict(curves=True)
        return results | {"scheme": self.scheme.to_dict(curves=True)}


def _listed(shapes: ShaftShapes) -> dict[str, Any]:
    arrays = {
        name: value.tolist() for name, value in shapes._asdict().items() if isinstance(value, np.ndarray)
    }
    return {"name": shapes.name, "distance": None} | arrays


@public
def torsion_study(
    machine: Machine,
    *,
    holzer: Sequence[float | str] = (),
    measured: Mapping[str, MeasuredResponse] | None = None,
) -> TorsionStudy:
    """Study the torsional vibration of a train or of a driveline.

    Parameters
    ----------
    machine : Machine
        With a [train], or with a torsionally flexible driveline.
    holzer : sequence of float or str
        Frequencies of Holzer's tables [Hz], or texts: "20 rad/s", "300 rpm", natural frequencies as "f_3".
    measured : mapping of str to MeasuredResponse, optional
        Curves measured over the speed, by name, beside those of [train.measured]; `read_measured` reads them
        from a file.

    Returns
    -------
    TorsionStudy
        Free vibration; where something excites the train, forced vibration, stresses and the verdict.

    Raises
    ------
    InputError
        The machine has no train; a frequency that makes no sense.
    """
    free = free_vibration(machine)
    frequencies = [holzer_frequency(mode, free) for mode in holzer]
    in_range(holzer=(frequencies, not_negative(FREQUENCY)))
    tables = tuple(holzer_table(machine, frequency) for frequency in frequencies)
    damped = damped_vibration(machine, _service(machine)) if _is_damped(machine) else None
    moved = None
    if machine.train is not None and machine.train.transient is not None:
        moved = torsion_transient(machine)
    for name, curve in (measured or {}).items():
        if not isinstance(curve, MeasuredResponse):
            raise InputError(f"measured.{name}: found {show(curve)}, expected what read_measured reads")
    curves = {**({} if machine.train is None else machine.train.measured), **(measured or {})}
    if not is_excited(machine):
        if curves:
            remedy = "give [train.run], and an excitation"
            raise InputError(f"{machine.name}: no computed result to compare with the measurement: {remedy}")
        return TorsionStudy(machine, scheme(machine), free, tables, damped, transient=moved)
    at = excited_train(machine)
    forced = responded(at)
    stress, seen = shaft_stress(machine, forced), survey(machine, at, forced)
    speeds = at.torques.speeds
    diagram = campbell(machine, speed_range=(speeds[0], speeds[-1]))
    judged = verdict(machine, seen)
    misfire = misfire_verdict(machine, seen, judged.barred)
    return TorsionStudy(
        machine,
        scheme(machine),
        free,
        tables,
        damped,
        at,
        forced,
        stress if stress.shafts else None,
        judged,
        misfire,
        _along(machine, at, forced),
        _engines(machine, at),
        diagram,
        torque_peaks(seen),
        moved,
        meshed(at, forced) if at.train.gears else None,
        _stars(machine, free, diagram, at),
        tuple(_at_critical(machine, free, diagram)),
        tuple(overlay(seen, name, curve) for name, curve in curves.items()),
        critical_responses(seen, diagram),
        surveyed_fatigue(seen, judged, misfire),
    )


def _stars(
    machine: Machine, free: FreeVibration, diagram: CampbellDiagram, at: ExcitedTrain
) -> tuple[PhaseVectors, ...]:
    if not diagram.critical:
        return ()
    speeds = np.array([one.speed for one in diagram.critical])
    return phase_vectors(free, diagram, between(machine, at, speeds))


def _at_critical(machine: Machine, free: FreeVibration, diagram: CampbellDiagram) -> Iterator[HolzerTable]:
    """Holzer's table at each natural frequency that an order meets among the speeds."""
    for mode in sorted({one.mode for one in diagram.critical}):
        try:
            yield holzer_table(machine, float(free.natural_frequencies[mode]))
        except FindingError:
            # silent: a mode in which the first disc is at rest has no Holzer table from that disc
            # The first disc is at rest in this mode, from which the table starts.
            continue


def _service(machine: Machine) -> float | None:
    """Speed of service of a train, at which loads damp it and couplings carry their mean torque."""
    run = machine.train.run if machine.train is not None else None
    return None if run is None or not pulsates(machine.train) else run.service  # type: ignore[arg-type]


def _is_damped(machine: Machine) -> bool:
    train = train_of(machine)
    loads = any(load.exponent > 0 and load.damping_factor > 0 for load in train.loads.values())
    shafts = any(shaft.damping or shaft.loss_factor for shaft in train.shafts.values())
    gears = any(gear.damping or gear.loss_factor for gear in train.gears.values())
    controlled = any(driver.control is not None for driver in train.drivers.values())
    given = controlled or train.modal_damping is not None
    return given or loads or shafts or gears or any(disc.damping for disc in train.discs.values())


def _engines(machine: Machine, at: ExcitedTrain) -> dict[str, EngineData]:
    train = machine.train
    if train is None or train.run is None:
        return {}
    turning = dict(zip(at.referred.discs, at.referred.speed.tolist(), strict=True))
    return {
        one.name: engine_data(one.engine, train.run.service * turning[one.throws[0]])
        for one in train.installed
    }


def _along(machine: Machine, at: ExcitedTrain, forced: ForcedVibration) -> UnevennessAlong | None:
    """Speed fluctuation over the cylinders of an engine whose cylinders fire one after another."""
    train = machine.train
    if train is None or train.engine is None or train.engines or train.run is None:
        return None
    angles, cycle = firing_angles(train.engine.places, train.engine.firing_order, train.engine.cycle)
    # Two that fire at once share one rise of the speed, which then is none of either.
    if len(np.unique(np.round(np.remainder(angles, cycle), 6))) < len(angles):
        return None
    firing = {str(n + 1): angle for n, angle in enumerate(angles)}
    return unevenness_along(at, forced, firing, train.engine.strokes // 2, train.run.service)


def _balance(study: TorsionStudy) -> Iterator[str]:
    if study.transient is not None and study.transient.balance:
        yield f"Manoeuvre: {study.transient.balance}."
    at, train = study.excited, study.machine.train
    if at is None or train is None or train.is_driven or not train.loads:
        return
    if train.run is not None and train.run.loads_follow:
        least, most = float(at.torques.load_factor.min()), float(at.torques.load_factor.max())
        if abs(least - 1) > _BALANCED or abs(most - 1) > _BALANCED:
            same = f"{least:.4g}" == f"{most:.4g}"
            factor = f"{least:.4g} at all speeds" if same else f"{least:.4g} to {most:.4g} over the speeds"
            yield (
                f"Steady running: loads were scaled by {factor}, to the torque of the engine "
                "(train.run.loads_follow = true)."
            )
        return
    if not is_balanced(at):
        left = at.torques.surplus
        yield (
            f"Steady running: loads keep their given torque; an excess torque of {left.min():+.5g} to "
            f"{left.max():+.5g} N m of the engine accelerates the train (train.run.loads_follow = true "
            "scales the loads instead)."
        )


def is_balanced(at: ExcitedTrain) -> bool:
    """Whether the mean torques on a train leave no excess at any speed."""
    taken = np.abs(at.referred.speed[:, None] * at.torques.mean).sum(axis=0)
    return not bool((np.abs(at.torques.surplus) > _BALANCED * taken).any())


def _warnings(study: TorsionStudy) -> Iterator[str]:
    forced, at, train = study.forced, study.excited, study.machine.train
    yield from () if study.transient is None else (f"Manoeuvre: {note}." for note in study.transient.notes)
    yield from () if train is None else _about_throws(train)
    if forced is None or at is None:
        if train is not None and pulsates(train):
            yield "Torques pulsate, but no speeds are given: forced vibration needs [train.run]."
        if train is not None and train.loads and train.run is None and study.transient is None:
            yield (
                "The loads damp only at the speeds of [train.run]: without it, natural frequencies and "
                "damping ratios neglect the slope of the load torques."
            )
        return
    yield from () if study.verdict is None else (f"{note}." for note in study.verdict.notes)
    yield from () if study.misfire is None else _about_misfires(study.misfire)
    for one in study.fatigue:
        if one.outside:
            listed = ", ".join(one.outside)
            name = f"Crankshaft {one.engine}".rstrip()
            yield f"{name}: {listed} outside the range of IACS UR M53; its factor Q is no verdict."
    unbounded = forced.speeds[~np.isfinite(forced.shaft_torque_max).all(axis=0)]
    if study.peaks is not None:
        # Between the speeds of the run too.
        unbounded = np.unique(np.append(unbounded, study.peaks.speed[np.isinf(study.peaks.vibratory)]))
    if len(unbounded):
        rpm = ", ".join(f"{speed * 30 / np.pi:.5g}" for speed in unbounded[:4])
        yield f"Speeds of {rpm} rpm are undamped resonances: the amplitude there is unbounded."
    run = None if train is None else train.run
    if run is not None and not run.speed_min <= run.service <= run.speed_max:
        near = min(max(run.service, run.speed_min), run.speed_max) * 30 / np.pi
        yield f"The service speed is not among the speeds analysed: the results are those of {near:.5g} rpm."
    if train is not None and not train.is_driven and at.referred.is_free:
        yield from _balance_warnings(train, at)
    yield from _about_loads(study, at)
    yield from _about_couplings(study, forced)
    yield from () if train is None else _about_pendulums(train, forced)
    yield from limited_controllers(at, forced)
    yield from _about_the_ends(study, forced)
    rest = np.flatnonzero(~forced.together.together)
    if len(rest):
        lines = forced.lines
        listed = ", ".join(lines[n] if forced.offsets[n] else f"{forced.orders[n]:.5g}" for n in rest[:4])
        yield (
            f"Orders {listed} have no common base with the others: the peaks of each family are added, an "
            "upper bound."
        )


def _about_pendulums(train: Train, forced: ForcedVibration) -> Iterator[str]:
    for name, pendulum in train.pendulums.items():
        amplitude = np.nan_to_num(swing(name, pendulum, forced), posinf=0.0)
        most = int(amplitude.argmax())
        if pendulum.swing_permitted is None and amplitude[most] > _LARGE_SWING:
            yield (
                f"The pendulum {name} would swing by {np.degrees(amplitude[most]):.4g}° at "
                f"{forced.speeds[most] * 30 / np.pi:.5g} rpm: linear vibration holds for small swings only; "
                "more mass swings less, and swing_permitted sets a limit."
            )


def _about_throws(train: Train) -> Iterator[str]:
    for name, engine, _ in train.installed:
        if engine.throw is None or engine.stiffness is not None or len(engine.throws) < 2:
            continue
        if remark := compliance_remarks(engine.throw).get(engine.stiffness_formula):
            word = "Engine" if engine.machine == "engine" else "Compressor"
            of = f"{word} {name}".rstrip()
            formula = engine.stiffness_formula.replace("_", " ")
            yield f"{of}: the throw is outside the range of the formula {formula}: {remark}."


def _about_misfires(verdict: MisfireVerdict) -> Iterator[str]:
    by_cylinder: dict[str, list[str]] = {}
    for row in verdict.judgements:
        if row.above is not None:
            low, high = (speed * 30 / np.pi for speed in row.above)
            words = f"{row.part}, {row.what}, {row.found / row.permitted:.3g} times the limit"
            by_cylinder.setdefault(row.cylinder, []).append(f"{words} within {low:.5g} to {high:.5g} rpm")
    for cylinder, parts in by_cylinder.items():
        listed = "; ".join(parts)
        yield f"Cylinder {cylinder} misfiring: {listed}: restrict the operation with a misfiring cylinder."


def _balance_warnings(train: Train, at: ExcitedTrain) -> Iterator[str]:
    if not train.loads:
        left = at.torques.surplus
        if is_balanced(at):
            return
        if any(driver.torque is not None for driver in train.drivers.values()):
            yield (
                f"The torques of engine and drivers leave an excess of {left.min():+.5g} to "
                f"{left.max():+.5g} N m, which accelerates the train."
            )
            return
        yield "The engine drives no load: its mean torque accelerates the train, and the shafts carry it."
        return
    # Behind the throws there are loads and drivers alone, and all loads drive if one does.
    behind = slice(sum(len(one.throws) for one in train.installed), None)
    driven = at.referred.speed[behind] @ at.torques.mean[behind] > 0
    if driven.any():
        rpm = ", ".join(f"{speed * 30 / np.pi:.5g}" for speed in at.torques.speeds[driven][:4])
        yield f"The mean torque of the engine is not positive at {rpm} rpm: the loads drive the engine there."


def _about_loads(study: TorsionStudy, at: ExcitedTrain) -> Iterator[str]:
    speeds, run = at.torques.speeds, study.machine.train.run if study.machine.train is not None else None
    service = speeds[-1] if run is None else run.service
    factor = float(at.torques.load_factor[np.abs(speeds - service).argmin()])
    # Loads that drive the engine are reported by themselves.
    if at.train.loads and factor > 0 and abs(factor - 1) > _FITS:
        yield (
            f"At the service speed the loads were scaled by {factor:.3g} to take the power of the engine. "
            "Check torque and speed of [train.loads], or the mean effective pressure of the gas."
        )


def _about_couplings(study: TorsionStudy, forced: ForcedVibration) -> Iterator[str]:
    couplings = {} if study.machine.train is None else study.machine.train.couplings
    for name, coupling in couplings.items():
        if coupling.torque is None:
            continue
        carried = float(np.abs(forced.mean_torques[forced.shafts.index(name)]).max())
        if carried > coupling.torque[-1]:
            yield (
                f"Coupling {name} carries {carried:.4g} N m, but its curve ends at "
                f"{coupling.torque[-1]:.4g} N m: beyond it the last slope is used."
            )


def _about_the_ends(study: TorsionStudy, forced: ForcedVibration) -> Iterator[str]:
    rows = () if study.verdict is None else study.verdict.judgements
    ends = (forced.speeds[0], forced.speeds[-1])
    near = [row for row in rows if row.speed in ends and row.found > _NEAR * row.permitted > 0]
    if near:
        parts = ", ".join(dict.fromkeys(judgement.part for judgement in near))
        yield (
            f"{parts}: the utilisation is largest at an end of the speed range and may be larger beyond it; "
            "widen [train.run]."
        )
