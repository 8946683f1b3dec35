"""``linkwright forces`` and ``linkwright balance``."""

from __future__ import annotations

from collections.abc import Iterator
from functools import partial
from typing import TYPE_CHECKING, Annotated, Any

from linkwright.drive.crank_speed import speed_words, speeds_of
from linkwright.kernel.command.answer import Answer
from linkwright.kernel.command.common import (
    Curves,
    FolderOutput,
    Output,
    ZeroAt,
    belong_to,
    named_entries,
    to_file,
    to_folder,
)
from linkwright.kernel.command.parameter import Option, Value
from linkwright.kernel.command.value import option_value
from linkwright.kernel.errors import InputError
from linkwright.kernel.later import later
from linkwright.kernel.units.kinds import ANGLE, ANGULAR_ACCELERATION, LENGTH, SPEED
from linkwright.machine.file_argument import File, MachineFile

if TYPE_CHECKING:
    from linkwright.kernel.figure.style import CaptionedFigure
    from linkwright.kernel.page.table import Table
    from linkwright.kinetostatics.balancing import Balance
    from linkwright.kinetostatics.friction import Friction
    from linkwright.kinetostatics.result import Forces
    from linkwright.kinetostatics.shaking_orders import ShakingOrders
    from linkwright.machine.machine import Machine

Speed = Annotated[
    float | None,
    Value(
        "--speed",
        SPEED,
        'Constant speed of the crank, such as "10 rad/s" or "90 rpm". Default: the steady motion.',
    ),
]
Span = Annotated[
    str | None,
    Option(
        "--angles",
        '"FROM, TO"',
        'With --speed: range of crank angles, such as "-20 deg, 50 deg", for a mechanism '
        "that does not rotate fully.",
    ),
]
At = Annotated[
    float | None,
    Value(
        "--at", ANGLE, "Components of all forces at this one crank angle, at --speed or at the design speed."
    ),
]
Acceleration = Annotated[
    float | None,
    Value(
        "--acceleration",
        ANGULAR_ACCELERATION,
        'Angular acceleration of the crank, such as "20 rad/s^2", with --speed or --at. Default: none.',
    ),
]
To = Annotated[
    FolderOutput,
    to_folder("Write results.json, forces.csv and figures as SVG and PNG there.", curves=Curves),
]
Cases = Annotated[
    list[str] | None,
    Option("--case", '"NAME: PATH=VALUE; …"', 'A load case, such as "idle: loads.work.force=0". Repeatable.'),
]
Frictions = Annotated[
    list[str] | None,
    Option(
        "--friction",
        '"PAIR: KEY=VALUE, …"',
        'Friction of a pin, guide or slot, such as "A: radius=20 mm, coefficient=0.1" or "S.guide: '
        'coefficient=0.1"; also viscous, and length of a guide. Repeatable.',
    ),
]
Angle = Annotated[float, Value("--pressure-angle", ANGLE, "Pressure angle of all teeth.", "20 deg")]


# Intervals between the ends of --angles.
_ANGLES = 360

# What a revolution may differ from 2π [rad].
_WHOLE_TURN = 1e-6


def forces(
    file: File,
    at: At = None,
    speed: Speed = None,
    acceleration: Acceleration = None,
    angles: Span = None,
    zero: ZeroAt = None,
    case: Cases = None,
    friction: Frictions = None,
    *,
    pressure_angle: Angle,
    to: To,
) -> None:
    """Compute the forces in a machine.

    Joint reactions of all pins, guides, slots, teeth and cables, driving torque, shaking force and moment;
    along the steady motion, or at a constant speed; in one pose with --at.
    """
    from linkwright.drive.warnings import unjudged_limits
    from linkwright.linkages.law_jumps import shaft_of_laws
    from linkwright.linkages.whole_cycle import first_revolution_words
    from linkwright.linkages.zero import zero_of, zero_over

    if at is not None and angles is not None:
        raise InputError("--at and --angles: one crank angle or a range, not both")
    if acceleration is not None and speed is None and at is None:
        raise InputError("--acceleration: it belongs to --speed or --at; a steady motion has its own")
    given = {"speed": speed, "acceleration": acceleration, "angles": angle_range(angles, speed)}
    options = {"pressure_angle": pressure_angle} | {k: x for k, x in given.items() if x is not None}
    machine = file.read()
    if at is not None:
        options["angles"] = [at + zero_of(machine, zero).angle]
    cases = _cases(file, machine, case or [], friction or [], options)
    orders = _orders(machine, cases)
    speeds = {
        name: speeds_of(result.speed, machine, speed, is_pose=at is not None)
        for name, result in cases.items()
    }
    answer = Answer(
        machine=machine,
        is_described=True,
        zero=zero_over(machine, zero, *cases.values()),
        results=partial(_results, cases, speeds, orders),
        findings=[
            _named(name, finding, cases) for name, result in cases.items() for finding in result.findings
        ],
        warnings=[
            *nothing_to_carry(machine),
            *first_revolution_words(machine),
            *shaft_of_laws(machine),
            *unjudged_limits(machine),
        ],
        head=partial(_head, speeds),
        tables=partial(_tables, machine, cases, orders),
        files={
            f"forces{end}.csv": later("kernel.page.table:curves_csv", result)
            for end, result in _numbered(cases)
        },
        figures=partial(_figures, cases),
    )
    to.hand_over(answer)


def nothing_to_carry(machine: Machine) -> list[str]:
    """That all forces are zero, where nothing has mass or load."""
    if machine.bodies or machine.all_loads:
        return []
    words = "The machine has no masses and no loads: all forces are zero. Add [bodies] and [loads]."
    if machine.pumping_unit is not None and machine.pumping_unit.load is not None:
        words += " The load of [pumping_unit.load] belongs to the torque factors of `linkwright run`."
    return [words]


def _head(speeds: dict[str, dict[str, Any]]) -> str:
    words = {name: speed_words(speed) for name, speed in speeds.items()}
    return "\n".join(
        [f"{name}: {said}" for name, said in words.items()] if len(words) > 1 else words.values()
    )


def _orders(machine: Machine, cases: dict[str, Forces]) -> ShakingOrders | None:
    from math import pi

    from linkwright.kinetostatics.couple import has_axial
    from linkwright.kinetostatics.shaking_orders import shaking_orders
    from linkwright.linkages.whole_cycle import over_whole_motion
    from linkwright.machine.program.compiled import compile_machine

    (first, *more) = cases.values()
    motion = first.motion
    turn = float(motion.crank_angle[-1] - motion.crank_angle[0])
    if more or not has_axial(machine) or not motion.speed.all():
        return None
    repeating = over_whole_motion(compile_machine(machine))
    if repeating is None or abs(turn - 2 * pi * repeating.turns) > _WHOLE_TURN:
        return None
    return shaking_orders(machine, speed=turn / float(motion.time[-1] - motion.time[0]))


def _tables(machine: Machine, cases: dict[str, Forces], orders: ShakingOrders | None) -> list[Table]:
    from linkwright.kinetostatics.cylinder import cylinder_force
    from linkwright.kinetostatics.cylinder_report import cylinder_tables
    from linkwright.kinetostatics.tables import (
        cases_table,
        contribution_table,
        envelope_table,
        orders_table,
        pose_tables,
    )

    if all(len(result.crank_angle) == 1 for result in cases.values()):
        return pose_tables(cases)
    if len(cases) > 1:
        return [cases_table(cases)]
    (only,) = cases.values()
    by_order = [] if orders is None else [orders_table(orders)]
    cylinders = [cylinder_force(machine, name, only) for name in machine.mechanism.cylinders]
    return [envelope_table(only), *cylinder_tables(cylinders), *by_order, contribution_table(only)]


def _named(name: str, finding: str, cases: dict[str, Forces]) -> str:
    return finding if len(cases) == 1 else f"{name}: {finding}"


def angle_range(span: str | None, speed: float | None) -> list[float] | None:
    """Crank angles between the ends of ``--angles``; None without it."""
    if span is None:
        return None
    ends = [option_value("--angles", end.strip(), ANGLE) for end in span.split(",")]
    if len(ends) != 2 or ends[0] >= ends[1] or speed is None:
        found = f'"{span}"' + ("" if speed is not None else " without --speed")
        raise InputError(f"--angles: found {found}, expected two increasing angles, and --speed")
    low, high = ends
    return [low + (high - low) * k / _ANGLES for k in range(_ANGLES + 1)]


def _cases(
    file: MachineFile, machine: Machine, cases: list[str], frictions: list[str], options: dict[str, Any]
) -> dict[str, Forces]:
    from linkwright.kinetostatics.forces import forces as compute

    options["friction"] = frictions_of(machine, frictions)
    if not cases:
        return {machine.name: compute(machine, **options)}
    named = dict(named_entries("--case", text, "idle: loads.work.force=0") for text in cases)
    return {name: compute(file.read(entries), **options) for name, entries in named.items()}


def frictions_of(machine: Machine, texts: list[str]) -> dict[str, Friction]:
    """Friction by name of the pair, as ``--friction`` says it."""
    from linkwright.linkages.model.structure import structure

    if not texts:
        return {}
    pairs = structure(machine.linkage).pairs
    frictions = {}
    for text in texts:
        # The last colon with a blank: a pin's name may hold one.
        name, colon, entries = text.rpartition(": ")
        if not colon:
            example = '"A: radius=20 mm, coefficient=0.1"'
            raise InputError(f'--friction: found "{text}", expected pair, colon and entries, as in {example}')
        is_pin = name in pairs and pairs[name].kind == "pin"
        frictions[name] = _friction(entries, is_pin=is_pin)
    return frictions


def _friction(entries: str, *, is_pin: bool) -> Friction:
    from linkwright.kernel.units.kinds import DAMPING, LENGTH, RATIO, TORSIONAL_DAMPING
    from linkwright.kinetostatics.friction import Friction

    kinds = {"coefficient": RATIO, "radius": LENGTH, "length": LENGTH}
    kinds["viscous"] = TORSIONAL_DAMPING if is_pin else DAMPING
    values = {}
    for entry in entries.split(","):
        key, sign, value = (part.strip() for part in entry.partition("="))
        if not sign or key not in kinds:
            raise InputError(
                f'--friction: found "{entry.strip()}", expected {", ".join(kinds)} with = and a value'
            )
        values[key] = option_value(f"--friction {key}", value, kinds[key])
    return Friction(**values)


def _results(
    cases: dict[str, Forces],
    speeds: dict[str, dict[str, Any]],
    orders: ShakingOrders | None,
    curves: bool,
) -> dict[str, dict[str, Any]]:
    from linkwright.kinetostatics.envelope import envelope

    results = {}
    for name, result in cases.items():
        rows = {
            extent.name: {k: v for k, v in vars(extent).items() if k != "name"} for extent in envelope(result)
        }
        # A pose has no course: what its table shows are curves of one point.
        with_curves = curves or len(result.crank_angle) == 1
        results[name] = result.to_dict(curves=with_curves) | speeds[name] | {"envelope": rows}
        if orders is not None:
            results[name]["shaking_orders"] = orders.to_dict()
    return results


def _figures(cases: dict[str, Forces]) -> Iterator[CaptionedFigure]:
    from linkwright.kernel.figure.style import CaptionedFigure
    from linkwright.kinetostatics.figures import captioned_forces, cases_figure

    if len(cases) > 1:
        yield CaptionedFigure("load_cases", "Load cases", "", cases_figure(cases))
    for (end, result), case in zip(_numbered(cases), cases, strict=True):
        for one in captioned_forces(result) if len(result.crank_angle) > 1 else ():
            title = f"{one.title}, {case}" if end else one.title
            yield one._replace(name=f"{one.name}{end}", title=title)


def _numbered(cases: dict[str, Forces]) -> list[tuple[str, Forces]]:
    return [("" if len(cases) == 1 else f"_{n}", result) for n, result in enumerate(cases.values(), start=1)]


Links = Annotated[
    str | None,
    Option(
        "--links",
        "LINK,…",
        "Links with counterweights, such as A,R.rocker; they must rotate about fixed points.",
    ),
]
Partial = Annotated[
    str | None,
    Option(
        "--slider",
        "SLIDER",
        "Instead of --links: a counterweight on the crank for a share of the mass of this slider.",
    ),
]
Share = Annotated[float, Option("--share", "X", "With --slider: share of the reciprocating mass.")]
Radius = Annotated[
    float | None,
    Value(
        "--radius",
        LENGTH,
        "Distance of the counterweights from their pivots. Default: the length of the link.",
    ),
]
Planes = Annotated[
    str | None,
    Option(
        "--planes",
        '"LENGTH, LENGTH"',
        "With --links: one or two places along the crankshaft, each with a counterweight on every link; "
        "two balance the shaking couple of bodies with axial as well.",
    ),
]
ToFile = Annotated[Output, to_file("Write the machine with counterweights there.")]


def balance(
    file: File,
    links: Links = None,
    slider: Partial = None,
    share: Share = 0.5,
    radius: Radius = None,
    planes: Planes = None,
    speed: Speed = None,
    *,
    to: ToFile,
) -> None:
    """Find counterweights.

    Those on given links that minimise the shaking force of inertia, or one on the crank against a
    share of a slider's mass; and what they change.
    """
    from linkwright.kinetostatics.balancing import balance as fit
    from linkwright.kinetostatics.balancing import partial_balance
    from linkwright.kinetostatics.motion import has_speed

    machine = file.read()
    if (links is None) == (slider is None):
        found = "neither" if links is None else "both"
        raise InputError(f"--links or --slider: found {found}, expected one of them")
    if slider is not None:
        if planes is not None:
            raise InputError("--planes: it belongs to --links")
        balanced = partial_balance(machine, slider, share=share, speed=speed, radius=radius)
    else:
        belong_to("--slider", "share")
        names = [name.strip() for name in (links or "").split(",") if name.strip()]
        at_planes = [option_value("--planes", text.strip(), LENGTH) for text in (planes or "0 m").split(",")]
        balanced = fit(machine, names, speed=speed, radius=radius, planes=at_planes)
    speeds = speeds_of(balanced.before.speed, machine, speed)
    if speed is None and not has_speed(machine):
        speeds["speed_source"] = "the file has no drive.speed: counterweights are the same at any speed"
    measures = {name: {"before": a, "after": b} for name, (a, b) in balanced.measures().items()}
    answer = Answer(
        machine=machine,
        is_described=True,
        results={"balance": {**speeds, "counterweights": _by_place(balanced), "rms": measures}},
        findings=balanced.after.findings,
        head=speed_words(speeds),
        tables=later("kinetostatics.tables:balance_tables", balanced),
        machine_file=later("machine.write:dumps", balanced.machine),
    )
    to.hand_over(answer)


def _by_place(balanced: Balance) -> dict[str, dict[str, Any]]:
    has_planes = len({weight.axial for weight in balanced.counterweights}) > 1
    return {
        f"{weight.link} at {weight.axial:.6g} m" if has_planes else weight.link: {
            k: v for k, v in vars(weight).items() if k != "link" or has_planes
        }
        for weight in balanced.counterweights
    }
