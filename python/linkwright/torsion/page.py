"""What the report of a study of torsional vibration says, and its page."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from linkwright.kernel.page.content import Content, Few, Part
from linkwright.kernel.page.formulas import Formula
from linkwright.kernel.page.html import html
from linkwright.kernel.page.table import Table
from linkwright.kernel.reader.numbers import number, parted
from linkwright.kernel.reader.out_units import with_units_of
from linkwright.kernel.reader.sentences import sentence, sentences
from linkwright.machine.table import grouped, machine_parts
from linkwright.machine.write import in_own_units
from linkwright.torsion.excitation.excited_train import ExcitedTrain
from linkwright.torsion.figures.captions import torsion_figures
from linkwright.torsion.limits.survey import TorquePeaks
from linkwright.torsion.model.train import GROUND, Train
from linkwright.torsion.study import TorsionStudy, is_balanced
from linkwright.torsion.tables.manoeuvre import manoeuvre_tables
from linkwright.torsion.tables.torsion import (
    detail_tables,
    forced_tables,
    free_tables,
    holzer_tables,
    system_part,
    verdict_tables,
)

_SOURCES = (
    "Den Hartog, Mechanical Vibrations, 4th ed. 1956; Ker Wilson, Practical Solution of Torsional Vibration "
    "Problems, 1956–1968; Paper 3: “Динаміка крутильних коливань V-подібних двигунів авіаційної наземної "
    "техніки” (Dynamics of torsional vibration of V-type engines of aviation ground equipment)"
)


def torsion_html(study: TorsionStudy, *, command: str = "") -> str:
    """The report of a study of torsional vibration as one HTML page; `command`: the command that made it."""
    return html(torsion_content(study, command))


def torsion_content(study: TorsionStudy, command: str = "") -> Content:
    """What the report of a study of torsional vibration says."""
    with with_units_of(study.machine.units):
        return _content(study, command)


def _content(study: TorsionStudy, command: str) -> Content:
    return Content(
        title=study.machine.name,
        about=study.machine.description or "",
        source=study.machine.source or "",
        notes=[
            (title, sentence(text))
            for title, text in (("Operation", study.operation), ("Balance of mean torques", study.balance))
            if text
        ],
        findings=sentences(study.findings),
        warnings=sentences(study.warnings),
        headline=[Few(*line) for line in _headline(study)],
        parts=list(_parts(study)),
        formulas=list(_formulas(study)),
        papers=_SOURCES,
        groups=grouped(machine_parts(study.machine)),
        assumptions=list(_assumptions(study)),
        file=in_own_units(study.machine),
        command=command or "linkwright torsion machine.toml --out report",
    )


def _parts(study: TorsionStudy) -> Iterator[Part]:
    figures = {figure.name: figure for figure in torsion_figures(study)}

    def part(title: str, tables: Iterator[Table], *names: str) -> Iterator[Part]:
        shown = [figures.pop(name) for name in list(figures) if name.startswith(names)] if names else []
        listed = list(tables)
        if listed or shown:
            yield Part(title, listed, shown)

    yield from part("Verdict", verdict_tables(study), "stress", "measured", "gears")
    yield from part("Torsional system", system_part(study), "scheme")
    yield from part(
        "Natural frequencies and critical speeds", free_tables(study), "mode_shapes", "campbell", "stars"
    )
    moving = () if study.transient is None else manoeuvre_tables(study.transient)
    manoeuvre = list(part("Manoeuvre", iter(moving), "transient", "waterfall"))
    yield from part("Forced vibration", forced_tables(study), "")
    yield from manoeuvre
    yield from part("Excitation and mode shapes", detail_tables(study))
    details = (table for one in study.critical_holzer for table in holzer_tables(one))
    yield from part("Holzer's tables of the modes in the speed range", details)


def _headline(study: TorsionStudy) -> Iterator[tuple[str, str, str]]:
    steady = () if study.verdict is None else study.verdict.judgements
    moved = () if study.transient is None else study.transient.judgements
    if steady or moved:
        state = "ok" if study.verdict is None else study.verdict.state
        words = {"ok": "all within limits", "bar": "barred speed ranges", "exceeds": "limits exceeded"}
        yield "verdict", words["exceeds" if study.findings else state], ""
    if steady:
        worst = max(steady, key=lambda row: row.found / row.permitted if row.permitted else np.inf)
        if worst.permitted and np.isfinite(worst.found):
            words_of = f"highest utilisation, {worst.part} {worst.what}"
            yield words_of, f"{100 * worst.found / worst.permitted:.3g}", "%"
    twisting = [f for f in study.free.natural_frequencies.tolist() if f > 0]
    if twisting:
        yield "lowest natural frequency", *parted(twisting[0], "Hz")
    forced = study.forced
    if forced is None:
        return
    if study.peaks is not None and forced.shafts:
        yield from _largest_torque(study.peaks)
    run = study.machine.train.run if study.machine.train is not None else None
    if run is not None:
        at = int(np.argmin(np.abs(forced.speeds - run.service)))
        yield "minimum speed fluctuation in service", number(float(forced.unevenness[:, at].min()), 3), ""
        yield "maximum speed fluctuation in service", number(float(forced.unevenness[:, at].max()), 3), ""


def _largest_torque(peaks: TorquePeaks) -> Iterator[tuple[str, str, str]]:
    worst = int(peaks.vibratory.argmax())
    value, rpm = float(peaks.vibratory[worst]), float(peaks.speed[worst]) * 30 / np.pi
    words = f"largest vibratory torque, {peaks.shafts[worst]} at {rpm:.5g} rpm"
    if np.isfinite(value):
        yield words, *parted(value, "N m")
    else:
        yield words, "unbounded", ""


def _formulas(study: TorsionStudy) -> Iterator[Formula]:
    den_hartog = "Den Hartog, chapter 5"
    yield Formula("Free vibration", "( K − ω^2 J ) θ = 0", den_hartog)
    if study.free.along:
        yield Formula("Distributed inertia of a uniform shaft", "β = ω root(J|k)", "Rao, section 8.4")
        yield Formula("", "M_1 = frac(k β|sin β) ( θ_1 cos β − θ_2 )", "Wittrick and Williams, 1971")
    if study.forced is None:
        return
    yield Formula("Forced vibration at order ν and speed Ω", "ω = ν Ω", den_hartog)
    yield Formula("", "( K ( 1 + i η ) + i ω C − ω^2 J ) θ_ν = M_ν", "Ker Wilson, vol. 4")
    yield Formula("Orders summed in phase", "θ ( t ) = Σ Re θ_ν e^iνΩt", "Ker Wilson, vol. 2")
    yield Formula("Speed fluctuation", "δ = frac(ω_max − ω_min|ω_m)", "Paper 3")
    yield Formula("Heat", "P = frac(1|2) Σ ( ω^2 c + ω η k ) Δ^2", den_hartog)
    if study.meshes is not None:
        yield Formula("Application factor", "K_A = frac(T_m + T_v|T_m)", "ISO 6336-1, DNV-CG-0036")
    if study.fatigue:
        yield Formula("Fatigue of the crankshaft", "Q = frac(σ_DW|σ_v)", "IACS UR M53")
    if study.machine.train is not None and study.machine.train.installed:
        yield Formula(
            "Inertia torque of a throw", "M = − frac(1|2) J′ ( φ ) Ω^2", "Biezeno and Grammel, vol. 4"
        )


def _balanced(train: Train, at: ExcitedTrain | None) -> str:
    if at is not None and not train.is_driven and train.drivers and is_balanced(at):
        return "Mean torques of engines, drivers and loads balance."
    if train.is_driven:
        shares = ", ".join(f"{on} {share:.4g}" for on, share in train.shares.items() if share < 1)
        parts = f", by shares of the power: {shares}" if shares else ""
        driven = "compressors and loads" if train.installed else "loads"
        return (
            f"Mean torques balance: the drivers give the torque of the {driven}{parts}; the slope of these "
            "torques over the speed acts as damping."
        )
    if train.run is not None and train.run.loads_follow:
        return (
            "Mean torques balance: the loads take the torque of the engines; the slope of their torque "
            "over the speed acts as damping."
        )
    return (
        "Loads keep their given torque, and its slope over the speed acts as damping; the excess torque "
        "of the engines accelerates the train."
    )


def _inertia_of_shafts(study: TorsionStudy) -> str:
    names = ", ".join(shape.name for shape in study.free.along)
    if not names:
        return "Discs are rigid; half of the given inertia of a shaft is added to each disc at its ends."
    moved = " In the manoeuvre it is added to the discs at the ends." if study.transient is not None else ""
    return f"Discs are rigid; the inertia of {names} is distributed along the shaft, exactly.{moved}"


def _about_friction(train: Train | None) -> Iterator[str]:
    """How vibration takes the parts with dry friction."""
    if train is None or not train.rubs:
        return
    engaged = [name for name, clutch in train.clutches.items() if clutch.closed]
    opened = [name for name in train.clutches if name not in engaged]
    backstops = [name for name, wheel in train.freewheels.items() if GROUND in wheel.between]
    elastic = [name for name, wheel in train.freewheels.items() if wheel.stiffness is not None]
    locked = [name for name in train.freewheels if name not in (*backstops, *elastic)]
    rubbing = [*train.brakes, *backstops]
    if engaged or locked:
        yield f"In modes and forced vibration {', '.join([*engaged, *locked])} is engaged and rigid."
    if elastic:
        yield f"In modes and forced vibration {', '.join(elastic)} is locked, and its spring twists."
    if opened:
        yield f"In modes and forced vibration {', '.join(opened)} is open and carries nothing."
    if rubbing:
        yield f"Modes and forced vibration leave out the friction of {', '.join(rubbing)}."


def _assumptions(study: TorsionStudy) -> Iterator[str]:
    yield _inertia_of_shafts(study)
    yield from _about_friction(study.machine.train)
    if study.forced is None:
        yield "Free vibration is undamped."
        return
    yield "The vibration is steady and small: torques follow the mean angle, not the vibration."
    yield "Loss factors η do not depend on the frequency."
    train = study.machine.train
    if train is None:
        yield (
            "The mechanism is a disc with its mean inertia; the variation of its inertia acts as a torque. "
            "Modes and critical speeds are those of this disc; torques and speeds with the inertia at every "
            "angle are those of the elastic driveline (elastic_motion)."
        )
        return
    if train.installed:
        yield "A throw is a disc with its mean inertia; the variation of its inertia acts as a torque."
        yield "Gas pressure is that of steady running; cylinders differ only by their factors."
    if study.fatigue:
        yield (
            "Fatigue: a throw is a beam on two supports, under the forces of its rods at the speed of "
            "service; torsion is that of the worst misfire outside barred speed ranges."
        )
    if train.loads:
        yield _balanced(train, study.excited)
    for name, coupling in train.couplings.items():
        if coupling.twist is not None:
            yield f"Coupling {name} has the stiffness of its curve at the mean torque of each speed."
