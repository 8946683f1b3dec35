"""``linkwright size`` and ``linkwright motors``."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import asdict, dataclass
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any, Literal

from linkwright.kernel.command.answer import Answer
from linkwright.kernel.command.common import Output, belong_to, to_file, to_screen
from linkwright.kernel.command.console import bar
from linkwright.kernel.command.parameter import Group, Option, Value
from linkwright.kernel.command.value import option_value
from linkwright.kernel.later import later
from linkwright.kernel.units.kinds import ANGLE, INERTIA, LENGTH, POWER, PRESSURE, TIME, TORQUE
from linkwright.kernel.units.marks import not_negative
from linkwright.machine.file_argument import File
from linkwright.studies.commands.study_file import ToStudy, hand_over_study

if TYPE_CHECKING:
    from linkwright.drive.model.catalogue import CatalogueMotor
    from linkwright.kernel.page.table import Row, Table
    from linkwright.machine.machine import Machine
    from linkwright.sizing.flywheel import FlywheelChoice
    from linkwright.sizing.motor import Candidate, MotorChoice
    from linkwright.studies.plan import StudyPlan

Reserve = Annotated[float, Option("--power-reserve", "X", "Minimum ratio of rated to required power.")]
Unevenness = Annotated[
    float,
    Option("--unevenness", "X", "Required coefficient of speed fluctuation, (ω_max − ω_min)/ω_mean."),
]
By = Annotated[
    Literal["all", "fixed-start", "power"],
    Option(
        "--by",
        help="Checks for the choice. fixed-start: all except the start from the worst angle. power: only "
        "rated power and start.",
    ),
]
FreeRatio = Annotated[bool, Option("--free-ratio", help="Choose the gear ratio for each motor.")]
Together = Annotated[
    bool, Option("--together", help="Check each motor with its flywheel; a smaller motor may suffice.")
]
Inertia = Annotated[
    list[str] | None,
    Option("--inertia", "TYPE=VALUE", 'Inertia of a rotor, such as 4A132S6U3="0.04 kg m^2". Repeatable.'),
]
Catalogue = Annotated[
    Path | None,
    Option(
        "--catalogue",
        "FILE",
        "Choose from the motors of a CSV file (induction, DC or servo) instead of the catalogue.",
    ),
]
KeepMotor = Annotated[
    bool, Option("--keep-motor", help="Keep the motor of the file and size the flywheel alone.")
]
MinimumCost = Annotated[
    bool,
    Option("--minimum-cost", help="Choose motor, gear ratio and flywheel together for the minimum cost."),
]
PerKilowatt = Annotated[
    float | None,
    Option("--per-kilowatt", "X", "Price per kilowatt of motor, with --minimum-cost. Default: 150."),
]
PerKilogram = Annotated[
    float | None,
    Option("--per-kilogram", "X", "Price per kilogram of flywheel, with --minimum-cost. Default: 1.5."),
]
FlywheelRadius = Annotated[
    float | None,
    Value("--flywheel-radius", LENGTH, "Radius of the flywheel disc, with --minimum-cost. Default: 0.6 m."),
]
RunUpTime = Annotated[
    float | None, Value("--run-up-time", TIME, "Permitted time of the run-up, with --minimum-cost.")
]
PressureAngle = Annotated[
    float | None, Value("--pressure-angle", ANGLE, "Size the smallest cam within this pressure angle.")
]
ContactStress = Annotated[
    float | None, Value("--contact-stress", PRESSURE, "Permitted contact pressure of that cam.")
]
ShaftName = Annotated[
    str | None,
    Option("--shaft", "SHAFT", "Size the smallest damper that keeps this shaft within its limit."),
]
Stress = Annotated[float | None, Value("--stress", PRESSURE, "Permitted vibratory stress of that shaft.")]
TorqueLimit = Annotated[float | None, Value("--torque", TORQUE, "Permitted vibratory torque of that shaft.")]
Part = Annotated[str | None, Option("--part", "NAME", "Name of the cam or damper, if there are several.")]
To = Annotated[Output, to_file("Write the machine with motor and flywheel there.")]

# Places from which derivatives lead to the minimum cost.
_STARTS = 3

# Options that say how a motor is chosen.
_OF_A_MOTOR = ("reserve", "by", "free_ratio", "together", "inertia", "catalogue")

# Rated power over required power from which a motor is said to be large: twice what any reserve asks for.
_LARGE = 3.0

# Rows of the table beyond the motor that is chosen; larger ones are larger still.
_BEYOND = 2


@dataclass(frozen=True)
class MinimumCostOptions:
    """What a minimum cost is made of; None where the study has its own."""

    minimum_cost: MinimumCost = False
    per_kilowatt: PerKilowatt = None
    per_kilogram: PerKilogram = None
    flywheel_radius: FlywheelRadius = None
    run_up_time: RunUpTime = None


@dataclass(frozen=True)
class LimitOptions:
    """Limits of a cam or of a shaft; None where there is none."""

    pressure_angle: PressureAngle = None
    contact_stress: ContactStress = None
    shaft: ShaftName = None
    stress: Stress = None
    torque: TorqueLimit = None
    part: Part = None


def size(
    file: File,
    reserve: Reserve = 1.1,
    unevenness: Unevenness = 0.05,
    by: By = "all",
    free_ratio: FreeRatio = False,
    together: Together = False,
    inertia: Inertia = None,
    catalogue: Catalogue = None,
    keep_motor: KeepMotor = False,
    *,
    costs: Annotated[MinimumCostOptions, Group(MinimumCostOptions)],
    limits: Annotated[LimitOptions, Group(LimitOptions)],
    study: ToStudy = None,
    to: To,
) -> None:
    """Choose motor and flywheel; with --minimum-cost, a cam's or a shaft's limits, size by a study.

    The smallest motor of the catalogue that passes every check, then the flywheel on the crankshaft, both
    verified by analysing the machine again. --minimum-cost: motor, gear ratio and flywheel together;
    --pressure-angle: the smallest cam; --shaft: the smallest damper. Exit code 1 if nothing suffices.
    """
    from linkwright.drive.model.motor_file import read_motors
    from linkwright.sizing.flywheel import choose_flywheel
    from linkwright.sizing.motor import choose_motor

    machine = file.read()
    if (plan := _study(machine, costs, limits, unevenness)) is not None:
        from linkwright.studies.commands.optimise import optimum_answer

        if study is not None:
            hand_over_study(plan, study, file, machine, to)
        how = {"method": "gradient", "starts": _STARTS}
        to.hand_over(optimum_answer(plan, how, _untried(plan)))
        return
    belong_to("--minimum-cost, --pressure-angle or --shaft", "study")
    if keep_motor:
        belong_to("a choice of motor, without --keep-motor", *_OF_A_MOTOR)
        to.hand_over(_answer_of_flywheel(choose_flywheel(machine, unevenness)))
        return
    motor = choose_motor(
        machine,
        reserve=reserve,
        by=by,
        free_ratio=free_ratio,
        unevenness=unevenness,
        together=together,
        inertias=_inertias(inertia or []),
        catalogue=None if catalogue is None else read_motors(catalogue),
        track=_tracked,
    )
    flywheel = None
    if motor.chosen and motor.chosen.machine:
        kept = motor.chosen.flywheel_kept
        flywheel = choose_flywheel(motor.chosen.machine, unevenness, keep=kept)
    to.hand_over(_answer(machine, motor, flywheel))


def _untried(plan: StudyPlan) -> str:
    motor = plan.study.variables.get("motor")
    if motor is None or not motor.values:
        return ""
    types = [value["catalogue"] for value in motor.values]
    return (
        f"; motors tried: {', '.join(types)}; larger ones may suffice: write the study by --study FILE, "
        "add them to its values of motor, and run linkwright optimise FILE"
    )


# Options of a study by the options that ask for it.
_OWNERS = {
    "per_kilowatt": ("--minimum-cost",),
    "per_kilogram": ("--minimum-cost",),
    "flywheel_radius": ("--minimum-cost",),
    "run_up_time": ("--minimum-cost",),
    "contact_stress": ("--pressure-angle",),
    "stress": ("--shaft",),
    "torque": ("--shaft",),
    "part": ("--pressure-angle", "--shaft"),
}


def _study(
    machine: Machine, costs: MinimumCostOptions, limits: LimitOptions, unevenness: float
) -> StudyPlan | None:
    """The study that sizes for a cost or within limits; None where motor and flywheel are chosen.

    Refuses two questions at once, and limits of a question that is not asked.
    """
    from linkwright.kernel.errors import InputError
    from linkwright.studies.sizes import cam_study, damper_study, drive_study

    questions = {
        "--minimum-cost": costs.minimum_cost,
        "--pressure-angle": limits.pressure_angle is not None,
        "--shaft": limits.shaft is not None,
    }
    asked = [name for name, is_asked in questions.items() if is_asked]
    if len(asked) > 1:
        raise InputError(f"{asked[1]}: found it beside {asked[0]}, expected one of them")
    given = {name: value for name, value in (vars(costs) | vars(limits)).items() if value is not None}
    for name, owners in _OWNERS.items():
        if name in given and not set(asked) & set(owners):
            option = f"--{name.replace('_', '-')}"
            raise InputError(f"{option}: found it alone, expected it beside {' or '.join(owners)}")
    if not asked:
        return None
    belong_to(f"a choice of motor and flywheel, without {asked[0]}", *_OF_A_MOTOR, "keep_motor")
    if costs.minimum_cost:
        prices = {
            name: given[name] for name in ("per_kilowatt", "per_kilogram", "flywheel_radius") if name in given
        }
        return drive_study(machine, unevenness=unevenness, run_up_time=costs.run_up_time, **prices)
    belong_to("a flywheel", "unevenness")
    part = limits.part
    if limits.pressure_angle is not None:
        angle, stress = limits.pressure_angle, limits.contact_stress
        return cam_study(machine, part, pressure_angle=angle, contact_stress=stress)
    assert limits.shaft is not None
    return damper_study(machine, part, shaft=limits.shaft, stress=limits.stress, torque=limits.torque)


def _inertias(texts: Sequence[str]) -> dict[str, float]:
    from linkwright.kernel.errors import InputError

    inertias = {}
    for text in texts:
        type, equals, value = text.rpartition("=")
        if not equals:
            raise InputError(f'--inertia {text}\n  expected: TYPE=VALUE, such as 4A132S6U3="0.04 kg m^2"')
        inertias[type.strip()] = option_value("--inertia", value.strip().strip("\"'"), INERTIA)
    return inertias


def _tracked(types: Sequence[CatalogueMotor]) -> Iterator[CatalogueMotor]:
    """The types one by one, with a bar once that takes long."""
    with bar("motors") as watch:
        for done, motor in enumerate(types):
            watch(done / len(types))
            yield motor


def _file_text(machine: Machine, chosen: Candidate) -> str:
    import tomlkit

    from linkwright.machine.write import dumps
    from linkwright.sizing.motor import ESTIMATE

    document: Any = tomlkit.parse(dumps(machine))
    if chosen.inertia_estimated:
        document["drive"]["motor"]["inertia"].comment(ESTIMATE)
    return tomlkit.dumps(document)


def _answer(machine: Machine, motor: MotorChoice, flywheel: FlywheelChoice | None) -> Answer:
    from linkwright.sizing.warnings import lost, unjudged

    results = {
        "required_power": motor.required.to_dict(),
        "motor": motor.to_dict(),
        "flywheel": flywheel.to_dict() if flywheel else None,
    }
    fitted, chosen = None if flywheel is None else flywheel.machine, motor.chosen
    moved = chosen.machine if fitted is None and chosen else fitted
    return Answer(
        machine=machine,
        is_described=True,
        names=[candidate.type for candidate in motor.candidates],
        results=results,
        findings=[*([] if chosen else [motor.reason]), *lost(moved)],
        warnings=[*motor.warnings, *(flywheel.warnings if flywheel else ()), *unjudged(machine)],
        head=partial(_lead, machine.name, motor, flywheel),
        tables=partial(_tables_of_choice, motor),
        machine_file=partial(_file_text, fitted, chosen) if fitted and chosen else None,
    )


def _answer_of_flywheel(flywheel: FlywheelChoice) -> Answer:
    from linkwright.sizing.warnings import lost, unjudged

    machine = flywheel.machine
    return Answer(
        machine=machine,
        is_described=True,
        results={"flywheel": flywheel},
        findings=lost(machine),
        warnings=[*flywheel.warnings, *unjudged(machine)],
        head=lambda: "\n".join(_flywheel_words(flywheel)),
        tables=partial(_table_of_flywheel, flywheel),
        machine_file=later("machine.write:dumps", machine),
    )


def _table_of_flywheel(flywheel: FlywheelChoice) -> list[Table]:
    from linkwright.kernel.page.table import Table, rows_of

    names = (
        "inertia",
        "inertia_estimate",
        "excess_work",
        "unevenness",
        "unevenness_without",
        "run_up_time",
        "run_up_time_without",
    )
    return [Table("flywheel", "Flywheel", ("quantity", "", "value", ""), rows_of(flywheel, *names))]


def _lead(name: str, motor: MotorChoice, flywheel: FlywheelChoice | None) -> str:
    from linkwright.kernel.reader.numbers import quantity

    need = motor.required
    power, speed = quantity(need.power, "W", usual="kW"), quantity(need.speed, "rad/s")
    load = quantity(need.torque_load_mean, "N m")
    lines = [
        name,
        f"Required power {power} at {speed}",
        f"{need.formula}, mean load {load}, η {need.efficiency:.4g}",
    ]
    if motor.chosen:
        lines += [motor.reason, *_deciding(motor)]
    if flywheel:
        lines += _flywheel_words(flywheel)
    if others := len(motor.candidates) - len(_suited(motor)):
        lines.append(f"{others} types have another speed: see --free-ratio")
    return "\n".join(lines)


def _deciding(motor: MotorChoice) -> list[str]:
    from linkwright.kernel.reader.numbers import quantity

    assert motor.chosen is not None
    lines = []
    if decided := motor.decided_by:
        check, other = decided
        power = quantity(other.known.power_rated, "W", usual="kW")
        verdict = "is unknown and counts as failed" if check.passed is None else "fails"
        lines.append(
            f"decisive check: {check.title}; {other.type}, {power}, passes all others; this one {verdict}"
        )
        times = motor.chosen.known.power_rated / motor.required.power
        if times >= _LARGE:
            lines.append(f"its rated power is {times:.3g} times the power required")
        if check.name == "starting_torque_worst":
            meant = "is a start under load meant? " if times >= _LARGE else ""
            lines.append(f"{meant}if the machine starts from its start angle only, use --by fixed-start")
    return lines + [f"not decisive: {check.brief}" for check in motor.chosen.open]


def _tables_of_choice(motor: MotorChoice) -> list[Table]:
    from linkwright.kernel.page.checks import check_table
    from linkwright.kernel.page.table import Table
    from linkwright.kernel.reader.numbers import measured, quantity

    tables = [check_table("checks_present", "The motor in the file", motor.present)] if motor.present else []
    if chosen := motor.chosen:
        title = f"{chosen.type} at ratio {chosen.ratio:.4g}"
        tables.append(check_table("checks_chosen", title, chosen.checks))
    rows: list[Row] = [
        (
            candidate.type,
            "",
            quantity(candidate.known.power_rated, "W", usual="kW"),
            f"{candidate.ratio:.4g}",
            measured(candidate.inertia, "kg m²", digits=3, before="~" if candidate.inertia_estimated else ""),
            _verdict(candidate, motor),
        )
        for candidate in _shown(motor)
    ]
    heads = ("type", "", "power", "ratio", "inertia, ~ estimated", "verdict")
    return [*tables, Table("motors_considered", "Motors considered", heads, rows)]


def _shown(motor: MotorChoice) -> list[Candidate]:
    ranked = sorted(_suited(motor), key=lambda candidate: candidate.known.power_rated)
    enough = [candidate for candidate in ranked if candidate.known.power_rated >= 0.5 * motor.required.power]
    enough = enough if len(enough) > _BEYOND else ranked[-_BEYOND - 1 :]
    if motor.chosen is None:
        return enough
    at = next(n for n, candidate in enumerate(enough) if candidate is motor.chosen)
    beyond = [candidate for candidate in enough[at + 1 :] if candidate.passes]
    return [*enough[: at + 1], *beyond[:_BEYOND]]


def _suited(motor: MotorChoice) -> list[Candidate]:
    return [candidate for candidate in motor.candidates if candidate.checks[0].passed] or list(
        motor.candidates
    )


def _verdict(candidate: Candidate, motor: MotorChoice) -> str:
    if candidate is motor.chosen:
        return "chosen"
    return (
        "passes, larger than needed"
        if candidate.passes
        else ", ".join(check.brief for check in candidate.failed)
    )


def _flywheel_words(flywheel: FlywheelChoice) -> list[str]:
    from linkwright.kernel.reader.numbers import quantity

    if flywheel.kept:
        return [
            f"The flywheel of the machine is kept: the speed fluctuation is {flywheel.unevenness:.4f}, "
            f"required is at most {flywheel.unevenness_wanted:g}"
        ]
    without = flywheel.unevenness_without
    bare = "there is no steady motion" if without is None else f"the speed fluctuation is {without:.4f}"
    if flywheel.inertia == 0:
        return [f"No flywheel is needed: {bare}, required is at most {flywheel.unevenness_wanted:g}"]
    size, estimate = (quantity(x, "kg m²") for x in (flywheel.inertia, flywheel.inertia_estimate))
    return [
        f"Flywheel {size} on the crankshaft for a speed fluctuation of {flywheel.unevenness:.6g}; without it "
        f"{bare}",
        f"classical estimate {estimate}, from an excess work of {quantity(flywheel.excess_work, 'J')}",
    ]


Poles = Annotated[int | None, Option("--poles", "N", "Only motors with this number of poles.")]
PowerMin = Annotated[str, Option("--power-min", "POWER", 'Minimum rated power, such as "5.5 kW".')]
Series = Annotated[str, Option("--series", "NAME", "Only motors of this series.")]


def motors(
    poles: Poles = None,
    power_min: PowerMin = "0 W",
    series: Series = "",
    *,
    to: Annotated[Output, to_screen()],
) -> None:
    """List the motors of the catalogue.

    An inertia with ~ is estimated by similarity, since its source prints none; a breakdown torque with ≥ is
    the minimum of IEC 60034-1, a starting torque with ≥ that of IEC 60034-12 for design N; a dash is a number
    that the source does not give. A machine file takes one by drive.motor.catalogue.
    """
    chosen = _chosen(poles, power_min, series)
    answer = Answer(
        machine=None,
        names=[known.type for known in chosen],
        results=lambda curves: {"motors": [_entries(known) for known in chosen]},
        tables=partial(_tables, chosen),
    )
    to.hand_over(answer)


def _chosen(poles: int | None, power_min: str, series: str) -> list[CatalogueMotor]:
    from linkwright.drive.model.catalogue import motors
    from linkwright.kernel.description.base import suggestion
    from linkwright.kernel.errors import InputError

    power, known = option_value("--power-min", power_min, not_negative(POWER)), motors()
    names = list(dict.fromkeys(motor.series for motor in known))
    if series and series not in names:
        raise InputError(f'--series: there is no series "{series}": {suggestion(series, names)}')
    numbers = sorted({motor.poles for motor in known})
    if poles is not None and poles not in numbers:
        listed = ", ".join(map(str, numbers))
        raise InputError(f"--poles: found {poles}, the catalogue has motors with {listed} poles")
    chosen = [
        motor
        for motor in known
        if motor.power_rated >= power and poles in (None, motor.poles) and series in ("", motor.series)
    ]
    if not chosen:
        raise InputError(_none_of(poles, power_min, series, known))
    return sorted(chosen, key=lambda motor: (motor.poles, motor.power_rated))


def _none_of(poles: int | None, power_min: str, series: str, known: Sequence[CatalogueMotor]) -> str:
    like = [motor for motor in known if series in ("", motor.series)]
    numbers = sorted({motor.poles for motor in like})
    if poles is not None and poles not in numbers:
        listed = ", ".join(map(str, numbers))
        return f"--poles: found {poles}, the series {series} has motors with {listed} poles"
    most = max(motor.power_rated for motor in like if poles in (None, motor.poles)) / 1000
    return (
        f'--power-min: found "{power_min}", expected at most {most:g} kW, the most powerful of these motors'
    )


def _entries(motor: CatalogueMotor) -> dict[str, Any]:
    from linkwright.sizing.motor_change import rotor_inertia

    inertia, estimated = rotor_inertia(motor)
    return {
        **asdict(motor),
        "torque_breakdown": motor.breakdown,
        "torque_breakdown_is_minimum": motor.breakdown_is_minimum,
        "torque_start": motor.start.get("torque_start"),
        "torque_start_is_minimum": motor.start_is_minimum,
        "inertia": inertia,
        "inertia_is_estimated": estimated,
    }


def _tables(motors: list[CatalogueMotor]) -> list[Table]:
    from linkwright.kernel.page.table import Table

    heads = ("type", "", "power", "speed", "torque", "breakdown", "start", "inertia")
    poles = dict.fromkeys(motor.poles for motor in motors)
    return [
        Table(
            f"motors_{n}",
            f"Motors of the catalogue with {n} poles",
            heads,
            [_row(motor) for motor in motors if motor.poles == n],
        )
        for n in poles
    ]


def _row(motor: CatalogueMotor) -> Row:
    from linkwright.kernel.reader.numbers import measured, number, quantity

    entries = _entries(motor)
    mark = "~" if entries["inertia_is_estimated"] else ""
    start = motor.start.get("torque_start")
    surely = "≥ " if motor.start_is_minimum else ""
    least = "≥ " if motor.breakdown_is_minimum else ""
    over = (
        "–" if motor.breakdown is None else f"{least}{number(motor.breakdown / motor.torque_rated, 3)} ×",
        "–" if start is None else f"{surely}{number(start / motor.torque_rated, 3)} ×",
    )
    return (
        motor.type,
        "",
        quantity(motor.power_rated, "W", 3, usual="kW"),
        quantity(motor.speed_rated, "rad/s", usual="rpm"),
        measured(motor.torque_rated, "N m"),
        *over,
        quantity(entries["inertia"], "kg m²", 2 if mark else 3, before=mark),
    )
