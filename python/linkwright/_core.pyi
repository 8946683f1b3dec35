"""The compiled kernels, for files named `core` and `machine.program` alone; all is SI and contiguous.

Fields of elements, loads and the drive that are integers are indices of points, links, slides and dyads, or
slots: places of numbers in the list of parameters. A compiled module has one stub, however long.
"""

from collections.abc import Mapping, Sequence
from typing import Any, Final, final

import numpy as np
from numpy.typing import NDArray

__all__ = [
    "FORMAT",
    "MESH_STEPS_MAX",
    "SEARCH_STEPS_MAX",
    "SEARCH_TURNS_MAX",
    "At",
    "Bar",
    "BarPoint",
    "Body",
    "Cam",
    "CamCrossings",
    "CamDimensions",
    "CamExtreme",
    "CamOffset",
    "CamPasses",
    "CamSearch",
    "CamShape",
    "ChangePoint",
    "Channel",
    "Condition",
    "Curve",
    "Drive",
    "DrivelineCurves",
    "DrivelineExtremes",
    "DrivelineGradient",
    "DrivelineInTime",
    "DrivelineInTimeCurves",
    "DrivelineMotion",
    "DrivelineRows",
    "DrivelineStation",
    "DrivelineTorque",
    "Element",
    "Extremes",
    "FmuMachine",
    "Formula",
    "GroundPoint",
    "GroupPath",
    "Harmonic",
    "InLine",
    "Line",
    "MotionInTime",
    "MotionLaw",
    "MotionVariations",
    "Motor",
    "MotorTorques",
    "NetTorques",
    "NoDrivelineMotion",
    "NoSteadyMotion",
    "OtherMotion",
    "Periodic",
    "Piece",
    "Plan",
    "Reductions",
    "RodMotions",
    "Span",
    "Status",
    "SteadyCurves",
    "SteadyGradient",
    "SteadyMotion",
    "SteadyRows",
    "SteadySolution",
    "Sum",
    "Table",
    "Term",
    "ThirdDerivatives",
    "TopperCover",
    "TopperKnife",
    "TorqueLaw",
    "TorqueShape",
    "TorsionController",
    "TorsionFriction",
    "TorsionGrip",
    "TorsionLink",
    "TorsionMass",
    "TorsionModes",
    "TorsionMotion",
    "TorsionPendulum",
    "TorsionRotor",
    "TorsionSystem",
    "TorsionTorque",
    "What",
    "cam_crossings",
    "driveline_branch",
    "driveline_in_time",
    "driveline_motion",
    "driveline_rows",
    "fmu_machine",
    "follow_group",
    "gaps",
    "in_line",
    "inertias_along",
    "kinks",
    "kinks_along",
    "law_torques",
    "least_inertias",
    "motion_at",
    "motions",
    "motions_along",
    "motor_torques",
    "predict_rods",
    "reductions",
    "rod_cards",
    "rods_along",
    "solve_systems",
    "steady_rows",
    "steady_state",
    "third",
    "torsion_forced",
    "torsion_modes",
    "torsion_waves",
    "transient",
    "transient_along",
]

_Floats = NDArray[np.float64]
_Ints = NDArray[np.int32]
_Complexes = NDArray[np.complex128]

FORMAT: int

# Most revolutions and steps of a search for periodic motions, and most steps of the mesh of one.
SEARCH_TURNS_MAX: int
SEARCH_STEPS_MAX: int
MESH_STEPS_MAX: int

@final
class Table:
    """Straight lines between points; raises ValueError unless x increases and all is finite.

    `first`: the first of the parameters that the points are as well, all places before all values.
    """

    def __new__(cls, x: Sequence[float], y: Sequence[float], first: int | None = None) -> Table: ...

@final
class Formula:
    """Instructions in postfix order, by the words of formulas.

    ``number`` with a slot, ``zero``, ``name`` with that of a variable, ``power`` with a whole exponent;
    operators and functions with none. ValueError for other words, or unless it leaves one number.
    """

    def __new__(cls, instructions: Sequence[tuple[str, int | str | None]]) -> Formula: ...

@final
class Harmonic:
    """a cos ku + b sin ku; frequency k [rad over the piece]."""

    def __new__(cls, *, frequency: float, cosine: float, sine: float) -> Harmonic: ...
    frequency: Final[float]
    cosine: Final[float]
    sine: Final[float]

@final
class Piece:
    """One piece of a motion law [rad]: Σ cᵢ uⁱ + harmonics, u = (φ − start)/length."""

    def __new__(
        cls,
        *,
        start: float,
        length: float,
        polynomial: Sequence[float],
        harmonics: Sequence[Harmonic],
    ) -> Piece: ...
    start: Final[float]
    length: Final[float]
    polynomial: Final[list[float]]
    harmonics: Final[list[Harmonic]]

@final
class MotionLaw:
    """Pieces that follow one another over a whole revolution; ValueError if they do not.

    `first`: the first of the parameters that their numbers are as well, piece by piece: start, length,
    polynomial, harmonics.
    """

    def __new__(cls, pieces: Sequence[Piece], first: int | None = None) -> MotionLaw: ...

@final
class Line:
    """A guide on a link or the frame: `offset` to the left of a point, turned by cos and sin."""

    def __new__(cls, *, through: int, link: int | None, cos: int, sin: int, offset: int) -> Line: ...
    through: Final[int]
    link: Final[int | None]
    cos: Final[int]
    sin: Final[int]
    offset: Final[int]

@final
class Term:
    """A slide, or the crank angle where there is none, times a factor."""

    def __new__(cls, *, slide: int | None, factor: int) -> Term: ...
    slide: Final[int | None]
    factor: Final[int]

@final
class Sum:
    """A constant and terms."""

    def __new__(cls, *, start: int, terms: Sequence[Term]) -> Sum: ...
    start: Final[int]
    terms: Final[Sequence[Term]]

@final
class Bar:
    """A link between two points."""

    def __new__(cls, *, link: int, start: int, end: int, inverse_length: int) -> Bar: ...
    link: Final[int]
    start: Final[int]
    end: Final[int]
    inverse_length: Final[int]

@final
class BarPoint:
    """A point fixed to a bar of a group, `along` and `across` in lengths of the bar."""

    def __new__(cls, *, point: int, start: int, end: int, along: int, across: int) -> BarPoint: ...
    point: Final[int]
    start: Final[int]
    end: Final[int]
    along: Final[int]
    across: Final[int]

class Condition:
    """What holds the joints of a group."""

    @final
    class Distance(Condition):
        """Two points at a distance."""

        __match_args__: Final = ("start", "end", "length")

        def __new__(cls, *, start: int, end: int, length: int) -> Condition.Distance: ...
        start: Final[int]
        end: Final[int]
        length: Final[int]

    @final
    class Length(Condition):
        """Two points at a distance that is a slide."""

        __match_args__: Final = ("start", "end", "slide")

        def __new__(cls, *, start: int, end: int, slide: int) -> Condition.Length: ...
        start: Final[int]
        end: Final[int]
        slide: Final[int]

    @final
    class OnLine(Condition):
        """A point on a guide of a link that is placed before."""

        __match_args__: Final = ("point", "line", "slide")

        def __new__(cls, *, point: int, line: Line, slide: int) -> Condition.OnLine: ...
        point: Final[int]
        line: Final[Line]
        slide: Final[int]

    @final
    class OnBar(Condition):
        """A point on a guide fixed to a bar of the group."""

        __match_args__: Final = ("point", "line", "slide", "bar")

        def __new__(cls, *, point: int, line: Line, slide: int, bar: Bar) -> Condition.OnBar: ...
        point: Final[int]
        line: Final[Line]
        slide: Final[int]
        bar: Final[Bar]

@final
class ChangePoint:
    """A change point, whose numbers stand in a row from slot `first` on."""

    def __new__(cls, *, first: int, has_arms: bool) -> ChangePoint: ...
    first: Final[int]
    has_arms: Final[bool]
    @property
    def cos(self) -> int:
        """Slot of cos φ."""

    @property
    def sin(self) -> int:
        """Slot of sin φ."""

    @property
    def reach(self) -> int:
        """Slot of the reach [rad], negative where a machine does not have the change point."""

@final
class GroundPoint:
    """A point of the ground."""

    def __new__(cls, *, point: int, x: int, y: int) -> GroundPoint: ...
    point: Final[int]
    x: Final[int]
    y: Final[int]

class Element:
    """One element: points, links, slides and dyads by their index, numbers by their slot.

    What it makes has the next indices; what it hangs on was made before.
    """

    @final
    class Crank(Element):
        """A crank that turns with φ + phase about a point of the ground; cos and sin of the phase."""

        __match_args__: Final = ("pin", "link", "pivot", "radius", "cos", "sin")

        def __new__(
            cls, *, pin: int, link: int, pivot: int, radius: int, cos: int, sin: int
        ) -> Element.Crank: ...
        pin: Final[int]
        link: Final[int]
        pivot: Final[int]
        radius: Final[int]
        cos: Final[int]
        sin: Final[int]

    @final
    class SliderRod(Element):
        """A rod from a pin to a slider on a fixed guide with direction `cos`, `sin`: the dyad RRP."""

        __match_args__: Final = (
            "point",
            "link",
            "slide",
            "dyad",
            "pin",
            "through",
            "rod",
            "inverse_rod",
            "offset",
            "cos",
            "sin",
            "sign",
        )

        def __new__(
            cls,
            *,
            point: int,
            link: int,
            slide: int,
            dyad: int,
            pin: int,
            through: int,
            rod: int,
            inverse_rod: int,
            offset: int,
            cos: int,
            sin: int,
            sign: int,
        ) -> Element.SliderRod: ...
        point: Final[int]
        link: Final[int]
        slide: Final[int]
        dyad: Final[int]
        pin: Final[int]
        through: Final[int]
        rod: Final[int]
        inverse_rod: Final[int]
        offset: Final[int]
        cos: Final[int]
        sin: Final[int]
        sign: Final[int]

    @final
    class Rocker(Element):
        """A coupler from a pin and a rocker from a pivot, joined: the dyad RRR, and its change points."""

        __match_args__: Final = (
            "joint",
            "coupler_link",
            "rocker_link",
            "dyad",
            "pin",
            "pivot",
            "coupler",
            "rocker",
            "inverse_coupler",
            "inverse_rocker",
            "sign",
            "change_points",
        )

        def __new__(
            cls,
            *,
            joint: int,
            coupler_link: int,
            rocker_link: int,
            dyad: int,
            pin: int,
            pivot: int,
            coupler: int,
            rocker: int,
            inverse_coupler: int,
            inverse_rocker: int,
            sign: int,
            change_points: Sequence[ChangePoint],
        ) -> Element.Rocker: ...
        joint: Final[int]
        coupler_link: Final[int]
        rocker_link: Final[int]
        dyad: Final[int]
        pin: Final[int]
        pivot: Final[int]
        coupler: Final[int]
        rocker: Final[int]
        inverse_coupler: Final[int]
        inverse_rocker: Final[int]
        sign: Final[int]
        change_points: Final[Sequence[ChangePoint]]

    @final
    class RigidPoint(Element):
        """A point fixed on a link, `along` it from its start and `across` to the left."""

        __match_args__: Final = ("point", "link", "origin", "along", "across")

        def __new__(
            cls, *, point: int, link: int, origin: int, along: int, across: int
        ) -> Element.RigidPoint: ...
        point: Final[int]
        link: Final[int]
        origin: Final[int]
        along: Final[int]
        across: Final[int]

    @final
    class GuidedRod(Element):
        """A rod from a pin to a slider on any guide: the dyad RRP, and its change points."""

        __match_args__: Final = (
            "point",
            "link",
            "slide",
            "dyad",
            "pin",
            "line",
            "rod",
            "inverse_rod",
            "sign",
            "change_points",
        )

        def __new__(
            cls,
            *,
            point: int,
            link: int,
            slide: int,
            dyad: int,
            pin: int,
            line: Line,
            rod: int,
            inverse_rod: int,
            sign: int,
            change_points: Sequence[ChangePoint],
        ) -> Element.GuidedRod: ...
        point: Final[int]
        link: Final[int]
        slide: Final[int]
        dyad: Final[int]
        pin: Final[int]
        line: Final[Line]
        rod: Final[int]
        inverse_rod: Final[int]
        sign: Final[int]
        change_points: Final[Sequence[ChangePoint]]

    @final
    class SlottedLever(Element):
        """A lever about a pivot whose slot, `offset` to the left, is moved by a pin: the dyad RPR."""

        __match_args__: Final = ("link", "slide", "dyad", "pin", "pivot", "offset", "sign")

        def __new__(
            cls, *, link: int, slide: int, dyad: int, pin: int, pivot: int, offset: int, sign: int
        ) -> Element.SlottedLever: ...
        link: Final[int]
        slide: Final[int]
        dyad: Final[int]
        pin: Final[int]
        pivot: Final[int]
        offset: Final[int]
        sign: Final[int]

    @final
    class Crossing(Element):
        """Where two guides cross: the dyads PRP and RPP."""

        __match_args__: Final = ("point", "slides", "dyad", "lines")

        def __new__(
            cls, *, point: int, slides: Sequence[int], dyad: int, lines: Sequence[Line]
        ) -> Element.Crossing: ...
        point: Final[int]
        slides: Final[Sequence[int]]
        dyad: Final[int]
        lines: Final[Sequence[Line]]

    @final
    class Turn(Element):
        """A link whose angle, kept as a slide, is a sum of other coordinates."""

        __match_args__: Final = ("link", "slide", "angle")

        def __new__(cls, *, link: int, slide: int, angle: Sum) -> Element.Turn: ...
        link: Final[int]
        slide: Final[int]
        angle: Final[Sum]

    @final
    class Runner(Element):
        """A point on a guide whose coordinate is a sum of others."""

        __match_args__: Final = ("point", "slide", "line", "place")

        def __new__(cls, *, point: int, slide: int, line: Line, place: Sum) -> Element.Runner: ...
        point: Final[int]
        slide: Final[int]
        line: Final[Line]
        place: Final[Sum]

    @final
    class AngleOf(Element):
        """The continuous angle of a link, within half a revolution of winding·φ + centre."""

        __match_args__: Final = ("link", "slide", "winding", "centre")

        def __new__(cls, *, link: int, slide: int, winding: int, centre: int) -> Element.AngleOf: ...
        link: Final[int]
        slide: Final[int]
        winding: Final[int]
        centre: Final[int]

    @final
    class Group(Element):
        """Joints that are found together from starts, x and y of each over φ·inverse_turns."""

        __match_args__: Final = (
            "dyad",
            "unknowns",
            "bar_points",
            "bars",
            "conditions",
            "starts",
            "inverse_turns",
            "repeats",
        )

        def __new__(
            cls,
            *,
            dyad: int,
            unknowns: Sequence[int],
            bar_points: Sequence[BarPoint],
            bars: Sequence[Bar],
            conditions: Sequence[Condition],
            starts: Sequence[Table],
            inverse_turns: int,
            repeats: bool,
        ) -> Element.Group: ...
        dyad: Final[int]
        unknowns: Final[Sequence[int]]
        bar_points: Final[Sequence[BarPoint]]
        bars: Final[Sequence[Bar]]
        conditions: Final[Sequence[Condition]]
        starts: Final[Sequence[Table]]
        inverse_turns: Final[int]
        repeats: Final[bool]

    @final
    class Link(Element):
        """A link between two points that are placed already."""

        __match_args__: Final = ("bar",)

        def __new__(cls, *, bar: Bar) -> Element.Link: ...
        bar: Final[Bar]

    @final
    class Law(Element):
        """A coordinate by a formula of the crank angle."""

        __match_args__: Final = ("slide", "formula")

        def __new__(cls, *, slide: int, formula: Formula) -> Element.Law: ...
        slide: Final[int]
        formula: Final[Formula]

    @final
    class Programme(Element):
        """A coordinate that follows a motion law from crank angle `phase` on."""

        __match_args__: Final = ("slide", "phase", "law")

        def __new__(cls, *, slide: int, phase: int, law: MotionLaw) -> Element.Programme: ...
        slide: Final[int]
        phase: Final[int]
        law: Final[MotionLaw]

class Body:
    """A body: a mass at a point, or a link with its centre of mass."""

    @final
    class Point(Body):
        """A mass [kg]."""

        __match_args__: Final = ("point", "mass")

        def __new__(cls, *, point: int, mass: int) -> Body.Point: ...
        point: Final[int]
        mass: Final[int]

    @final
    class Link(Body):
        """A link: centre from its start, mass [kg], inertia about the centre [kg m²]."""

        __match_args__: Final = ("link", "origin", "along", "across", "mass", "inertia")

        def __new__(
            cls, *, link: int, origin: int, along: int, across: int, mass: int, inertia: int
        ) -> Body.Link: ...
        link: Final[int]
        origin: Final[int]
        along: Final[int]
        across: Final[int]
        mass: Final[int]
        inertia: Final[int]

class At:
    """Where a load acts."""

    @final
    class Bodies(At):
        """All bodies, in proportion to their mass, in a direction."""

        __match_args__: Final = ("cos", "sin")

        def __new__(cls, *, cos: int, sin: int) -> At.Bodies: ...
        cos: Final[int]
        sin: Final[int]

    @final
    class Crank(At):
        """The crankshaft, counter-clockwise."""

        __match_args__: Final = ()

        def __new__(cls) -> At.Crank: ...

    @final
    class Slide(At):
        """A slide, along its guide; `point` is the point that slides."""

        __match_args__: Final = ("slide", "point")

        def __new__(cls, *, slide: int, point: int) -> At.Slide: ...
        slide: Final[int]
        point: Final[int]

    @final
    class Point(At):
        """A point, along its path."""

        __match_args__: Final = ("point",)

        def __new__(cls, *, point: int) -> At.Point: ...
        point: Final[int]

    @final
    class Toward(At):
        """A point, in a fixed direction."""

        __match_args__: Final = ("point", "cos", "sin")

        def __new__(cls, *, point: int, cos: int, sin: int) -> At.Toward: ...
        point: Final[int]
        cos: Final[int]
        sin: Final[int]

    @final
    class Along(At):
        """A point, in a direction that turns with a link."""

        __match_args__: Final = ("point", "link", "cos", "sin")

        def __new__(cls, *, point: int, link: int, cos: int, sin: int) -> At.Along: ...
        point: Final[int]
        link: Final[int]
        cos: Final[int]
        sin: Final[int]

    @final
    class Link(At):
        """A link, counter-clockwise."""

        __match_args__: Final = ("link",)

        def __new__(cls, *, link: int) -> At.Link: ...
        link: Final[int]

    @final
    class Between(At):
        """Two points, away from each other."""

        __match_args__: Final = ("start", "end")

        def __new__(cls, *, start: int, end: int) -> At.Between: ...
        start: Final[int]
        end: Final[int]

    @final
    class BetweenLinks(At):
        """A link against another, or the frame; cos and sin of its free angle."""

        __match_args__: Final = ("link", "other", "cos", "sin")

        def __new__(cls, *, link: int, other: int | None, cos: int, sin: int) -> At.BetweenLinks: ...
        link: Final[int]
        other: Final[int | None]
        cos: Final[int]
        sin: Final[int]

class What:
    """What a load is, with its table or formula: a force, or a torque on what turns."""

    @final
    class Constant(What):
        """A constant force or torque; on all bodies an acceleration."""

        __match_args__: Final = ("size",)

        def __new__(cls, *, size: int) -> What.Constant: ...
        size: Final[int]

    @final
    class Dry(What):
        """A constant resistance."""

        __match_args__: Final = ("size",)

        def __new__(cls, *, size: int) -> What.Dry: ...
        size: Final[int]

    @final
    class Viscous(What):
        """A resistance in proportion to the speed."""

        __match_args__: Final = ("damping",)

        def __new__(cls, *, damping: int) -> What.Viscous: ...
        damping: Final[int]

    @final
    class Spring(What):
        """A spring; `preload` is its pull at the free length."""

        __match_args__: Final = ("stiffness", "free_length", "preload")

        def __new__(cls, *, stiffness: int, free_length: int, preload: int) -> What.Spring: ...
        stiffness: Final[int]
        free_length: Final[int]
        preload: Final[int]

    @final
    class Gas(What):
        """A push that grows as gas is compressed."""

        __match_args__: Final = ("force", "length", "column", "exponent")

        def __new__(cls, *, force: int, length: int, column: int, exponent: int) -> What.Gas: ...
        force: Final[int]
        length: Final[int]
        column: Final[int]
        exponent: Final[int]

    @final
    class Curve(What):
        """A pull by a table over the position."""

        __match_args__: Final = ("table",)

        def __new__(cls, *, table: Table) -> What.Curve: ...
        table: Final[Table]

    @final
    class Resistance(What):
        """A resistance by tables over the position, one for each direction."""

        __match_args__: Final = ("forward", "back")

        def __new__(cls, *, forward: Table, back: Table) -> What.Resistance: ...
        forward: Final[Table]
        back: Final[Table]

    @final
    class OverAngle(What):
        """A table over the crank angle, that repeats after some revolutions."""

        __match_args__: Final = ("table", "turns")

        def __new__(cls, *, table: Table, turns: int) -> What.OverAngle: ...
        table: Final[Table]
        turns: Final[int]

    @final
    class OverSpeed(What):
        """A resistance by a table over the speed."""

        __match_args__: Final = ("table",)

        def __new__(cls, *, table: Table) -> What.OverSpeed: ...
        table: Final[Table]

    @final
    class Formula(What):
        """A formula; the crank angle that it knows starts again from 0 after some revolutions."""

        __match_args__: Final = ("formula", "turns")

        def __new__(cls, *, formula: Formula, turns: int) -> What.Formula: ...
        formula: Final[Formula]
        turns: Final[int]

@final
class Span:
    """A cubic of the motor's curve below breakdown, level at its right end, or at both."""

    def __new__(cls, *, x0: int, y0: int, x1: int, y1: int, inverse_width: int, is_level: bool) -> Span: ...
    x0: Final[int]
    y0: Final[int]
    x1: Final[int]
    y1: Final[int]
    inverse_width: Final[int]
    is_level: Final[bool]

class Motor:
    """Torque over speed at the motor's shaft."""

    @final
    class Constant(Motor):
        """The same at any speed."""

        __match_args__: Final = ("torque",)

        def __new__(cls, *, torque: int) -> Motor.Constant: ...
        torque: Final[int]

    @final
    class Line(Motor):
        """A straight line from standstill to the speed without load."""

        __match_args__: Final = ("torque", "inverse_speed")

        def __new__(cls, *, torque: int, inverse_speed: int) -> Motor.Line: ...
        torque: Final[int]
        inverse_speed: Final[int]

    @final
    class Induction(Motor):
        """An induction motor after Kloss, below breakdown by spans."""

        __match_args__: Final = ("inverse_synchronous", "torque", "slip", "resistance", "spans")

        def __new__(
            cls, *, inverse_synchronous: int, torque: int, slip: int, resistance: int, spans: Sequence[Span]
        ) -> Motor.Induction: ...
        inverse_synchronous: Final[int]
        torque: Final[int]
        slip: Final[int]
        resistance: Final[int]
        spans: Final[Sequence[Span]]

    @final
    class Table(Motor):
        """Straight lines between points."""

        __match_args__: Final = ("table",)

        def __new__(cls, *, table: Table) -> Motor.Table: ...
        table: Final[Table]

@final
class Drive:
    """The driveline: motor, if it is on, ratio, factors of torque, inertia, speed where a search starts."""

    def __new__(
        cls, *, motor: Motor | None, ratio: int, forward: int, reverse: int, inertia: int, speed_start: int
    ) -> Drive: ...
    motor: Final[Motor | None]
    ratio: Final[int]
    forward: Final[int]
    reverse: Final[int]
    inertia: Final[int]
    speed_start: Final[int]

@final
class Plan:
    """A machine's structure, of which every part is checked.

    Raises
    ------
    IndexError
        What is used was not made before, or what is made is not the next of its kind.
    ValueError
        A list has the wrong length.
    """

    def __new__(
        cls,
        *,
        parameters: int,
        ground: Sequence[GroundPoint],
        elements: Sequence[Element],
        bodies: Sequence[Body],
        loads: Sequence[tuple[At, What]],
        drive: Drive,
    ) -> Plan: ...
    @property
    def has_laws(self) -> bool:
        """Whether loads depend on both angle and speed in their own way, or on time."""

    @property
    def turns(self) -> int:
        """Revolutions of the crank after which all loads repeat."""

    def over_turns(self, turns: int) -> Plan:
        """The same over a cycle of which so many revolutions are a part too."""

    def without_conservative(self) -> Plan:
        """The same without loads that have a potential over the position of the mechanism."""

@final
class Status:
    """Why a machine has no answer; its number stands in `SteadyRows.status`."""

    OK: Final[Status]
    DOES_NOT_CLOSE: Final[Status]
    NO_STEADY_MOTION: Final[Status]
    INACCURATE: Final[Status]
    TWO_TURNS: Final[Status]
    SLIDES: Final[Status]
    NEUTRAL: Final[Status]
    UNDECIDED: Final[Status]
    NOT_CONVERGED: Final[Status]

    def __int__(self) -> int: ...
    @staticmethod
    def sentences() -> list[tuple[int, str]]:
        """Each number and what it means."""

@final
class OtherMotion:
    """Another motion that repeats [rad/s, s]; its multiplier is the share of a disturbance left after it."""

    speed_min: Final[float]
    speed_max: Final[float]
    period: Final[float]
    multiplier: Final[float]

@final
class SteadyMotion:
    """Steady motion of one machine.

    Curves at the crank angles asked for: time [s], speed [rad/s], acceleration [rad/s²], torques [N m],
    inertia [kg m²]. Of the revolution: extremes [rad/s, rad/s²] and their crank angles [rad], period [s],
    work [J], mean, root mean square and extremes of the motor's torque [N m], its maximum power [W]; the
    accuracy reached, and what it took.
    Speeds at φ = 0 above which the machine runs away, above and below which starts were not followed to an
    end [rad/s]; NaN where there are none.
    """

    time: Final[_Floats]
    speed: Final[_Floats]
    acceleration: Final[_Floats]
    torque_motor: Final[_Floats]
    torque_drive: Final[_Floats]
    torque_load: Final[_Floats]
    inertia_reduced: Final[_Floats]
    speed_min: Final[float]
    speed_max: Final[float]
    speed_min_angle: Final[float]
    speed_max_angle: Final[float]
    acceleration_min: Final[float]
    acceleration_max: Final[float]
    acceleration_min_angle: Final[float]
    acceleration_max_angle: Final[float]
    period: Final[float]
    multiplier: Final[float]
    energy_motor: Final[float]
    energy_drive: Final[float]
    energy_load: Final[float]
    torque_motor_mean: Final[float]
    torque_motor_rms: Final[float]
    torque_motor_min: Final[float]
    torque_motor_max: Final[float]
    power_motor_max: Final[float]
    accuracy: Final[float]
    sweeps: Final[int]
    steps: Final[int]
    others: Final[list[OtherMotion]]
    away_from: Final[float]
    undecided_above: Final[float]
    undecided_below: Final[float]
    solution: Final[SteadySolution]

@final
class SteadySolution:
    """The solution of a revolution, from which curves and derivatives are read without solving anew."""

    def curves(self, phi: _Floats) -> SteadyCurves:
        """Curves at crank angles in [0, 2π], fastest where these increase; (angles,) each."""

    def gradient(self, directions: _Floats, sizes: _Floats) -> SteadyGradient:
        """Derivatives along `directions` (parameters, n), by quantities of some `sizes`."""

@final
class SteadyCurves:
    """Curves of steady motion, or their derivatives, in one shape each.

    Time [s], speed [rad/s], acceleration [rad/s²], torques of motor, drive and loads [N m], inertia [kg m²].
    """

    time: Final[_Floats]
    speed: Final[_Floats]
    acceleration: Final[_Floats]
    torque_motor: Final[_Floats]
    torque_drive: Final[_Floats]
    torque_load: Final[_Floats]
    inertia_reduced: Final[_Floats]

@final
class NoSteadyMotion:
    """Why there is no steady motion; NaN where there is no such number.

    Crank angle at which the machine comes to rest or does not close [rad], speed from which it slows down
    or which it exceeds, or the fastest that repeats [rad/s], the slowest of a range that repeats at the same
    angle φ = 0 [rad/s], accuracy reached.
    """

    status: Final[Status]
    crank_angle: Final[float]
    speed: Final[float]
    speed_slowest: Final[float]
    accuracy: Final[float]

@final
class SteadyGradient:
    """Derivatives of steady motion along n directions of the parameters, each (n,).

    `lost` is the crank angle of a kink whose move was not found [rad], where all else is NaN; NaN where there
    is none.
    """

    speed_min: Final[_Floats]
    speed_max: Final[_Floats]
    acceleration_min: Final[_Floats]
    acceleration_max: Final[_Floats]
    period: Final[_Floats]
    multiplier: Final[_Floats]
    energy_motor: Final[_Floats]
    energy_drive: Final[_Floats]
    energy_load: Final[_Floats]
    torque_motor_mean: Final[_Floats]
    torque_motor_rms: Final[_Floats]
    lost: Final[_Floats]

    def curves(self, phi: _Floats) -> SteadyCurves:
        """Derivatives of curves at crank angles within the cycle, (angles, n) each.

        At the end of a step that moves with a kink a curve is followed along it.
        """

@final
class SteadyRows:
    """Steady motion of n machines: statuses, turns swept, quantities of `SteadyMotion`; (n,) each.

    Fast starts: 1 where the machine runs away, 2 where that was not decided, else 0.
    """

    status: Final[NDArray[np.uint8]]
    fast_starts: Final[NDArray[np.uint8]]
    turns_swept: Final[int]
    speed_min: Final[_Floats]
    speed_max: Final[_Floats]
    acceleration_min: Final[_Floats]
    acceleration_max: Final[_Floats]
    period: Final[_Floats]
    multiplier: Final[_Floats]
    energy_motor: Final[_Floats]
    energy_drive: Final[_Floats]
    energy_load: Final[_Floats]
    torque_motor_mean: Final[_Floats]
    torque_motor_rms: Final[_Floats]
    speed_min_angle: Final[_Floats]
    speed_max_angle: Final[_Floats]

@final
class MotionInTime:
    """Motion in time at the ends of the steps [s, rad, rad/s, rad/s²].

    How it ended by name, torques of drive and load there [N m], evaluations; of each step the factors of
    angle and speed, (steps, 2, 7) (`Stages::component` in `kernel/rk.rs`), and whether it is by the
    implicit method (steps,).
    """

    end: Final[str]
    time: Final[_Floats]
    crank_angle: Final[_Floats]
    speed: Final[_Floats]
    acceleration: Final[_Floats]
    factors: Final[_Floats]
    implicit: Final[NDArray[np.bool_]]
    torque_drive_end: Final[float]
    torque_load_end: Final[float]
    evaluations: Final[int]

@final
class InLine:
    """Where the links of a dyad come into line.

    Machine, crank angle [rad], length to spare [m], numbers of the change point (none where it is undecided)
    and of its arms (none unless the pin passes near its pivot), and whether the arm with S > 0 (positive) or
    S < 0 (negative) after it has no digits left.
    """

    row: Final[int]
    crank_angle: Final[float]
    spare: Final[float]
    series: Final[list[float]]
    arms: Final[list[float]]
    lost_positive: Final[bool]
    lost_negative: Final[bool]

@final
class GroupPath:
    """Motion of a group: crank angles [rad], places there [m], a list a joint, turns of a period."""

    crank_angle: Final[_Floats]
    x: Final[list[list[float]]]
    y: Final[list[list[float]]]
    turns: Final[int | None]

def steady_state(plan: Plan, q: _Floats, accuracy: float, phi: _Floats) -> SteadyMotion | NoSteadyMotion:
    """Steady motion, with curves at the angles `phi`."""

@final
class DrivelineCurves:
    """Curves of a driveline over crank angles, (parts, n) each, all referred to the crank."""

    time: Final[_Floats]
    speed: Final[_Floats]
    acceleration: Final[_Floats]
    twist: Final[_Floats]
    torque: Final[_Floats]
    torque_drive: Final[_Floats]
    torque_load: Final[_Floats]

@final
class DrivelineTorque:
    """A torque on a mass of a driveline from outside, referred to the crank."""

    @staticmethod
    def own(mass: int) -> DrivelineTorque:
        """The motor of the plan at the crank."""

    @staticmethod
    def held(mass: int, speed: float) -> DrivelineTorque:
        """A motor that keeps a speed."""

    @staticmethod
    def motor(mass: int, plan: Plan, q: _Floats) -> DrivelineTorque:
        """The motor of another plan, through its gearbox."""

    @staticmethod
    def power(mass: int, *, torque: float, speed: float, exponent: float) -> DrivelineTorque:
        """A power of the speed of the mass, positive if it drives."""

@final
class DrivelineStation:
    """A further mechanism; its crank is at `ratio` times the angle of its mass plus `phase`."""

    def __new__(
        cls, mass: int, plan: Plan, q: _Floats, *, ratio: float, phase: float
    ) -> DrivelineStation: ...

@final
class DrivelineMotion:
    """Steady motion of a driveline: extremes and means over its masses, or over its links.

    All referred to the crank; torques and losses are those of the links.
    """

    period: Final[float]
    speed: Final[Extremes]
    acceleration: Final[Extremes]
    twist: Final[Extremes]
    torque: Final[Extremes]
    torque_mean: Final[_Floats]
    torque_rms: Final[_Floats]
    loss: Final[_Floats]
    torque_drive: Final[Extremes]
    torque_drive_mean: Final[_Floats]
    energy_drive: Final[_Floats]
    energy_load: Final[float]
    monodromy: Final[_Floats]
    accuracy: Final[float]
    steps: Final[int]
    cycles: Final[int]
    multiple: Final[int]
    start: Final[_Floats]

    def curves(self, phi: _Floats) -> DrivelineCurves:
        """Curves at crank angles of the cycle."""

    def gradient(self, directions: _Floats) -> DrivelineGradient:
        """Derivatives along directions of all numbers, of the plan and then of the driveline, (numbers, n).

        The driveline's are inertias, what is apart, stiffness, damping, half of the backlash and points of
        the curve of each link, numbers of drivers and loads, ratio and phase of each station, damping and
        share of each mass in `swing`.
        """

    def curves_along(self, directions: _Floats, phi: _Floats) -> _Floats:
        """Derivatives of speeds, accelerations, twists and torques, (parts · angles, n)."""

@final
class DrivelineGradient:
    """Derivatives along n directions, (n,), or (masses, links or drivers, n), referred to the crank."""

    period: Final[_Floats]
    energy_drive: Final[_Floats]
    energy_load: Final[_Floats]
    torque_mean: Final[_Floats]
    torque_rms: Final[_Floats]
    loss: Final[_Floats]
    speed_min: Final[_Floats]
    speed_max: Final[_Floats]
    acceleration_min: Final[_Floats]
    acceleration_max: Final[_Floats]
    twist_min: Final[_Floats]
    twist_max: Final[_Floats]
    torque_min: Final[_Floats]
    torque_max: Final[_Floats]
    torque_drive_min: Final[_Floats]
    torque_drive_max: Final[_Floats]
    torque_drive_mean: Final[_Floats]
    monodromy: Final[_Floats]

@final
class DrivelineInTimeCurves:
    """Curves of a driveline over time, (parts, n) each, all referred to the crank.

    Works count from the start of the motion: of the drivers at their shafts, behind the gearboxes, of the
    loads and brakes, and the heat of the links; `impulse` are integrals of the torques of the drivers.
    """

    angle: Final[_Floats]
    speed: Final[_Floats]
    acceleration: Final[_Floats]
    twist: Final[_Floats]
    torque: Final[_Floats]
    torque_drive: Final[_Floats]
    torque_load: Final[_Floats]
    energy_kinetic: Final[_Floats]
    energy_elastic: Final[_Floats]
    work_shaft: Final[_Floats]
    impulse: Final[_Floats]
    work_drive: Final[_Floats]
    work_load: Final[_Floats]
    work_brake: Final[_Floats]
    heat: Final[_Floats]

@final
class DrivelineInTime:
    """Motion in time of a driveline, with extremes over its masses or links; all referred to the crank.

    `time`, `crank_angle`: at the ends of the steps; `state`: at the end; `end`: ``"time"``, ``"turns"``,
    ``"rest"``, ``"does not close"`` or ``"inaccurate"``; `events`: number of the end of a step, what
    happened there, and the mass of it; `energy_error`: largest gain of energy less works, over the largest.
    """

    time: Final[_Floats]
    crank_angle: Final[_Floats]
    state: Final[_Floats]
    end: Final[str]
    torque_drive_end: Final[float]
    torque_load_end: Final[float]
    speed: Final[Extremes]
    acceleration: Final[Extremes]
    twist: Final[Extremes]
    torque: Final[Extremes]
    energy_error: Final[float]
    evaluations: Final[int]
    implicit: Final[int]
    events: Final[list[tuple[int, str, int | None]]]

    def curves(self, time: _Floats) -> DrivelineInTimeCurves:
        """Curves at times of the motion."""

@final
class NoDrivelineMotion:
    """Why there is none: ``"stops"`` at an angle and a speed, ``"not found"`` or ``"inaccurate"``.

    `parting`: factor by which neighbouring motions part in a cycle where none was found.
    """

    reason: Final[str]
    crank_angle: Final[float]
    speed: Final[float]
    accuracy: Final[float]
    parting: Final[float]

@final
class FmuMachine:
    """A machine as data for the library of an FMU."""

    data: Final[bytes]
    states: Final[int]
    event_indicators: Final[int]

def fmu_machine(
    plan: Plan,
    q: _Floats,
    *,
    motor: int,
    start: tuple[float, float],
    accuracy: float,
    parameters: Sequence[tuple[float, Sequence[tuple[int, float, float]]]],
    token: str,
    driveline: Mapping[str, Any] | None = None,
    brake: int | None = None,
    scales: Sequence[tuple[int, float]] = ...,
    ranges: Sequence[tuple[int, float, float]] = ...,
) -> FmuMachine:
    """A machine with its motor as data.

    `motor`: direction in which the motor drives, +1 or −1; `start`: crank angle [rad] and speed [rad/s].
    `parameters`: values v₀ and what each changes, slots with factors k and powers p: a slot changes by
    k (vᵖ − v₀ᵖ); behind those of the plan are the numbers of the driveline. `brake`: mass on which the brake
    acts, else the crank; `scales`: value references, and what their numbers are read times; `ranges`: value
    references, and between which numbers they may be set.
    """

def driveline_in_time(
    plan: Plan,
    q: _Floats,
    chain: Mapping[str, Any],
    *,
    state: _Floats,
    brakes: _Floats,
    time: float,
    motor: float,
    speed: float,
    until: float,
    turns: float,
    accuracy: float,
) -> DrivelineInTime:
    """Motion in time of masses with links as in `driveline_motion`.

    `state`: twists and speeds of all masses against the crank, its speed and its angle, at `time`; `brakes`:
    torque on every mass; `motor`: +1 or −1, the direction in which it drives; `speed`: about which the
    machine works; `until`, `turns`: time and revolutions at the end at the latest.
    """

def driveline_motion(
    plan: Plan,
    q: _Floats,
    chain: Mapping[str, Any],
    *,
    accuracy: float,
    speed: float,
    fastest: float,
    cycles_first: int,
    cycles_max: int,
    multiples: int,
    start: _Floats | None,
) -> DrivelineMotion | NoDrivelineMotion:
    """Steady motion of masses, the last of which is the crank, with links between them.

    `chain`: `inertia` of all masses but the crank; `apart`, what of the plan's inertia is not at the crank;
    `first`, `second`, `stiffness`, `damping` and `gap`, half of the backlash, of links; `curves`, twists,
    torques and slopes of those that are not straight, None of the others; lists `drivers` and `loads` of
    `DrivelineTorque`, `stations` of `DrivelineStation`; `swing`, damping of every mass against the rotation
    of all with its share in that, or None. `fastest`: size of the fastest eigenvalue that lasts; followed for
    `cycles_first` cycles at first, for `cycles_max` at most, to a motion that repeats after up to `multiples`
    of them, from a state `start` if given.
    """

def driveline_branch(
    plan: Plan,
    *,
    nodes: Sequence[float],
    machines: Sequence[tuple[_Floats, Mapping[str, Any]]],
    accuracy: float,
    fastest: float,
    parameter: float,
    start: DrivelineMotion,
    direction: float,
    points_max: int,
) -> tuple[list[tuple[float, bool, DrivelineMotion]], str]:
    """A branch of steady motions over a parameter from one of them in a direction, to an end of its range.

    `nodes`, `machines`: parameters, with numbers of the plan and masses and links of `driveline_motion`;
    between them numbers are polynomials. Gives parameter, whether it turns back there, and motion of each;
    why the branch ends: ``"range"``, ``"points"`` or ``"short"``, where steps became too short.
    """

@final
class DrivelineExtremes:
    """Extremes of masses, links or drivers of n machines, (parts, n)."""

    least: Final[_Floats]
    greatest: Final[_Floats]

@final
class DrivelineRows:
    """Steady motion of n drivelines, (n,) or (parts, n), referred to the crank; NaN where not found.

    `monodromy` is (numbers of the matrix, n).
    """

    period: Final[_Floats]
    speed: Final[DrivelineExtremes]
    acceleration: Final[DrivelineExtremes]
    twist: Final[DrivelineExtremes]
    torque: Final[DrivelineExtremes]
    torque_drive: Final[DrivelineExtremes]
    torque_drive_mean: Final[_Floats]
    torque_mean: Final[_Floats]
    torque_rms: Final[_Floats]
    loss: Final[_Floats]
    energy_drive: Final[_Floats]
    energy_load: Final[_Floats]
    monodromy: Final[_Floats]
    accuracy: Final[_Floats]

def driveline_rows(
    plan: Plan,
    q: _Floats,
    slots: _Ints,
    values: _Floats,
    chain: Mapping[str, Any],
    *,
    numbers: _Floats,
    accuracy: float,
    speed: _Floats,
    fastest: _Floats,
    cycles_max: int,
    multiples: int,
) -> DrivelineRows:
    """Steady motion of n machines with the driveline of one, whose numbers vary.

    `values` is (slots, n), `numbers` (n, numbers) in the order of `DrivelineMotion.gradient`; `speed` and
    `fastest` are (n,); the others as in `driveline_motion`.
    """

def least_inertias(plan: Plan, q: _Floats, slots: _Ints, values: _Floats, phi: _Floats) -> _Floats:
    """Minimum inertia reduced to the crank at crank angles, of n machines, (n,)."""

def steady_rows(plan: Plan, q: _Floats, slots: _Ints, values: _Floats, accuracy: float) -> SteadyRows:
    """Steady motion of n machines; `values` is (slots, n)."""

class Channel:
    """What moves, by its index."""

    @final
    class Point(Channel):
        """A point: x, y and their first and second derivatives by the crank angle."""

        __match_args__: Final = ("index",)

        def __new__(cls, index: int) -> Channel.Point: ...
        index: Final[int]

    @final
    class Link(Channel):
        """A link: cosine and sine of its angle, first and second derivative of the angle."""

        __match_args__: Final = ("index",)

        def __new__(cls, index: int) -> Channel.Link: ...
        index: Final[int]

    @final
    class Slide(Channel):
        """A slide: its coordinate, first and second derivative."""

        __match_args__: Final = ("index",)

        def __new__(cls, index: int) -> Channel.Slide: ...
        index: Final[int]

def motions(
    plan: Plan,
    q: _Floats,
    slots: _Ints,
    values: _Floats,
    phi: _Floats,
    what: Sequence[Channel],
    out: _Floats,
) -> bool:
    """Motions of n machines at the angles `phi` into `out` (n, numbers, angles).

    Returns: whether all numbers, and the sums of those of a point, link or slide, are finite.
    """

def motions_along(plan: Plan, q: _Floats, values: _Floats, phi: _Floats, what: Sequence[Channel]) -> _Floats:
    """Derivatives of motions by directions (parameters, n) at fixed angles, (numbers, angles × n)."""

def kinks_along(plan: Plan, q: _Floats, values: _Floats, phi: _Floats) -> _Floats:
    """Derivatives of crank angles by directions (parameters, n), where they are kinks, (angles, n)."""

def inertias_along(plan: Plan, q: _Floats, values: _Floats, phi: _Floats) -> _Floats:
    """Derivatives of the reduced inertia and of its slope by directions (parameters, n), (2 × angles, n)."""

@final
class ThirdDerivatives:
    """Third derivatives by the crank angle of points (points, 2, angles), of links and of slides."""

    points: Final[_Floats]
    links: Final[_Floats]
    slides: Final[_Floats]

def solve_systems(matrix: _Floats, right: _Floats) -> None:
    """Solve systems of equations A x = b of one shape, in place.

    Parameters
    ----------
    matrix : ndarray, shape (columns, equations, n)
        A of each system, column by column.
    right : ndarray, shape (sides, equations, n)
        Right sides b of each system, which x replaces: infinite or NaN where A is singular, NaN where a
        number of the system is not finite.
    """

def third(
    plan: Plan,
    q: _Floats,
    phi: _Floats,
    *,
    points: Sequence[int],
    links: Sequence[int],
    slides: Sequence[int],
) -> ThirdDerivatives:
    """Third derivatives at the angles `phi`."""

def in_line(plan: Plan, q: _Floats, slots: _Ints, values: _Floats, element: int) -> list[InLine]:
    """Where the links of a dyad come into line over the revolution, in each machine."""

def follow_group(plan: Plan, q: _Floats, element: int, phi: float, near: _Floats) -> GroupPath | None:
    """Motion of a group from places near those given (x, y of each joint); None if it does not close."""

def gaps(plan: Plan, q: _Floats, phi: _Floats) -> _Floats:
    """Radicand of each dyad at each angle (dyads, angles); negative where it does not close."""

@final
class Reductions:
    """The machine reduced to its crank, turning forward; (angles,) each.

    Inertia J [kg m²], dJ/dφ [kg m²/rad], torque of the loads but of dry friction [N m], that of dry friction
    [N m], viscous coefficient [N m s/rad].
    """

    inertia: Final[_Floats]
    inertia_slope: Final[_Floats]
    load: Final[_Floats]
    dry: Final[_Floats]
    viscous: Final[_Floats]

def reductions(plan: Plan, q: _Floats, phi: _Floats) -> Reductions:
    """The machine reduced to its crank at crank angles."""

def law_torques(plan: Plan, q: _Floats, phi: _Floats, omega: _Floats) -> _Floats:
    """Load torque of the laws at angles and speeds (speeds, angles)."""

@final
class MotorTorques:
    """Torque of the motor at its shaft and at the crank, (n,) each [N m]."""

    motor: Final[_Floats]
    crank: Final[_Floats]

def motor_torques(plan: Plan, q: _Floats, omega: _Floats) -> MotorTorques:
    """Torque of the motor at crank speeds."""

def transient(
    plan: Plan,
    q: _Floats,
    start: tuple[float, float],
    turning: tuple[int, int],
    duration: float,
    turns: float,
    accuracy: float,
) -> MotionInTime:
    """Motion in time from an angle and a speed until duration, turns or an event end it.

    Turning: the direction in which the crank turns, +1 counter-clockwise or −1, and that of the motor;
    the speed at the start is in the direction of the former.
    """

@final
class MotionVariations:
    """Derivatives of a motion in time at m instants along n directions, the instants held.

    Of angle and speed, (m, n) each; the acceleration itself, (m,). At an event what holds before it.
    """

    crank_angle: Final[NDArray[np.float64]]
    speed: Final[NDArray[np.float64]]
    acceleration: Final[_Floats]

def motion_at(
    time: _Floats, angle: _Floats, speed: _Floats, factors: _Floats, at: _Floats
) -> tuple[_Floats, _Floats]:
    """Angles and speeds of a `MotionInTime` at instants within it [rad, rad/s]."""

def transient_along(
    plan: Plan,
    q: _Floats,
    values: NDArray[np.float64],
    start: NDArray[np.float64],
    time: _Floats,
    states: NDArray[np.float64],
    between: NDArray[np.float64],
    at: _Floats,
) -> MotionVariations:
    """Derivatives of a counter-clockwise motion in time by directions of the parameters (parameters, n).

    Start: those of angle and speed, (2, n). The motion: times (k,), angles and speeds (2, k), factors of the
    steps (k − 1, 2, 7). Instants increase.
    """

def kinks(plan: Plan, q: _Floats) -> _Floats:
    """Crank angles between which the reduced machine is smooth, from 0 to 2π."""

@final
class CamDimensions:
    """Lengths of cam and follower [m], angle of the face [rad]; `Dimensions` in `cam/mod.rs`."""

    def __new__(
        cls,
        *,
        base_radius: float,
        roller_radius: float,
        offset: float,
        distance: float,
        arm: float,
        tilt: float,
    ) -> CamDimensions: ...
    base_radius: Final[float]
    roller_radius: Final[float]
    offset: Final[float]
    distance: Final[float]
    arm: Final[float]
    tilt: Final[float]

@final
class CamExtreme:
    """A maximum or minimum, and the cam angle where it is [rad]."""

    angle: Final[float]
    value: Final[float]

@final
class CamPasses:
    """Cam angles [rad] where a row passes a level, and the sign of row less level behind, (k,) each."""

    angle: Final[_Floats]
    sign: Final[_Floats]

@final
class CamShape:
    """A contact over a revolution.

    Angles (n,) [rad], pieces of the law, rows by name, extremes of pressure angle, bend and, under a flat
    face, place along it by name, and for each level asked for where its row passes it. The rows are `lift`
    and `lift_d1` to `lift_d3`, `pitch_x`, `pitch_y`, `normal_x`, `normal_y`, `pressure_angle`, `bend`,
    `soundness` and `along`.
    """

    angle: Final[_Floats]
    piece: Final[NDArray[np.uint32]]
    rows: Final[dict[str, _Floats]]
    greatest: Final[dict[str, CamExtreme]]
    least: Final[dict[str, CamExtreme]]
    passes: Final[list[CamPasses]]

@final
class CamOffset:
    """x, y of a curve beside the pitch curve [m] and two derivatives [m/rad, m/rad²], (2, n) each."""

    place: Final[_Floats]
    d1: Final[_Floats]
    d2: Final[_Floats]

@final
class CamSearch:
    """Largest tan γ, infinite where the follower locks, minimum soundness, extremes of the bend; (cams,)."""

    tan_pressure_angle: Final[_Floats]
    soundness: Final[_Floats]
    bend_max: Final[_Floats]
    bend_min: Final[_Floats]

@final
class Cam:
    """A motion law over a revolution and the cam that follows it: `crates/linkwright-cam/src`.

    `sense` is +1 for a cam that turns counter-clockwise, else −1; `side` +1 for an arm to the left of the
    line from cam to pivot, else −1.
    """

    def __new__(
        cls, law: MotionLaw, *, is_oscillating: bool, is_roller: bool, sense: float, side: float
    ) -> Cam: ...
    def shape(self, size: CamDimensions, n: int, levels: Sequence[tuple[str, float]]) -> CamShape:
        """The contact at about n angles per revolution; levels are name of the row and value."""

    def rows(self, size: CamDimensions, phi: _Floats, before: bool) -> dict[str, _Floats]:
        """The rows of `CamShape` at angles."""

    def rows_along(
        self,
        size: CamDimensions,
        phi: _Floats,
        before: bool,
        size_d: _Floats,
        lift_d: _Floats,
        phi_d: _Floats,
    ) -> dict[str, _Floats]:
        """Derivatives of the rows at angles, flat (angles, n): by directions of dimensions (6, n), of lift
        and its first three derivatives (4, angles, n) and of the angles (angles, n), flat each."""

    def curve(self, size: CamDimensions, phi: _Floats, before: bool, away: float) -> CamOffset:
        """A curve beside the pitch curve, at angles (n,)."""

    def search(
        self,
        *,
        base_radius: _Floats,
        roller_radius: _Floats,
        offset: _Floats,
        distance: _Floats,
        arm: _Floats,
        tilt: _Floats,
        lift: _Floats,
        n: int,
        per_turn: int,
    ) -> CamSearch:
        """Many cams: columns of one entry or one a cam, the last a factor on the lift."""

@final
class CamCrossings:
    """Crossings of a polygon's sides: number of the side and share along it of both, and place; (n,) each."""

    first: Final[_Floats]
    second: Final[_Floats]
    x: Final[_Floats]
    y: Final[_Floats]

def cam_crossings(x: _Floats, y: _Floats) -> CamCrossings:
    """Crossings of the sides of a closed polygon."""

@final
class TopperCover:
    """What heads need, and what an edge leaves; (heads,) each.

    Length needed and place of the point that is reached last [m]; areas left on the right of the edge, on
    its left, between two passes of it [m²].
    """

    length: Final[_Floats]
    last_x: Final[_Floats]
    last_y: Final[_Floats]
    uncut_right: Final[_Floats]
    uncut_left: Final[_Floats]
    uncut_between: Final[_Floats]

@final
class TopperKnife:
    """The knife of a topper, its law in pieces or as harmonics a, b, …: `topper` of the core.

    Phases of the law's corners [rad], angle of the edge [rad], speed forward [m/s], phase per time [rad/s],
    drift across the row [m/s], peak absolute value of the law [m], extremes of the speed across [m/s].
    """

    def __new__(
        cls,
        law: MotionLaw | _Floats,
        *,
        corners: Sequence[float],
        angle: float,
        forward: float,
        rate: float,
        drift: float,
        reach: float,
        slowest: float,
        fastest: float,
    ) -> TopperKnife: ...
    def cover(
        self,
        *,
        radius: _Floats,
        offset: _Floats,
        phase: _Floats,
        n: int,
        length: float | None,
        fine: int,
    ) -> TopperCover:
        """Many heads: columns of one entry or one a head; `fine` stations per revolution of the law."""

@final
class RodMotions:
    """Periodic motions of rod strings, a row each: cards (rows, stations, n), wave, mean load and change."""

    position: Final[_Floats]
    load: Final[_Floats]
    work: Final[_Floats]
    wave: Final[_Floats]
    ends: Final[_Floats]
    sweeps: Final[int]

def predict_rods(
    *,
    sections: int,
    numbers: _Floats,
    motion: _Floats,
    start: _Floats | None,
    tolerance: float,
    sweeps: int,
) -> RodMotions:
    """Motions under samples (rows, n) of the polished rods' positions, with cards of twice the samples.

    Numbers: EA [N], μ [kg/m], c [1/s], L [m] of each section; F₀ [N], κ [m/N], 1/(KA) [1/N], slip [m/s],
    fillage, D [N], 1/n of the pump; the period [s].
    """

def rods_along(
    *,
    sections: int,
    numbers: _Floats,
    motion: _Floats,
    start: _Floats,
    numbers_along: _Floats,
    motion_along: _Floats,
    tolerance: float,
    sweeps: int,
) -> RodMotions:
    """Derivatives of one motion, whose wave is `start`, by rows of directions of its numbers and samples."""

def rod_cards(
    *, sections: int, numbers: _Floats, position: _Floats, load: _Floats, harmonics: int
) -> RodMotions:
    """Cards by samples (rows, n) of position and load at the polished rods, of which `harmonics` count."""

def torsion_forced(
    *,
    parent: _Ints,
    inertia: _Floats,
    speeds: _Floats,
    stiffness: _Floats,
    damping: _Floats,
    loss: _Floats,
    disc_damping: _Floats,
    orders: _Floats,
    torques: _Complexes,
) -> None:
    """Amplitudes (orders, discs, speeds) in place of torques [N m → rad].

    k, c, ηk of the shaft above each disc and c of the disc itself, (discs, speeds) each.
    """

@final
class Extremes:
    """Maximum and minimum values of waves or of curves over time, and their places; (n,) each.

    Places are angles from 0 to 2π of waves, and times [s].
    """

    greatest: Final[_Floats]
    greatest_at: Final[_Floats]
    least: Final[_Floats]
    least_at: Final[_Floats]

def torsion_waves(coefficients: _Complexes) -> Extremes:
    """Extremes of sums of harmonics (harmonics, waves)."""

@final
class TorsionModes:
    """Natural frequencies (n,) [rad/s], increasing, and shapes with Σ J q² = 1, one row a mode (n, n)."""

    omega: Final[_Floats]
    shapes: Final[_Floats]

def torsion_modes(inertia: _Floats, ends: _Ints, stiffness: _Floats) -> TorsionModes | None:
    """Modes of a train; None where its shafts close a loop.

    Shafts join the masses of their ends (shafts, 2), −1 being the ground; without stiffness they do not.
    """

@final
class Curve:
    """Cubics through points with a slope at both sides of each; ValueError if places decrease."""

    def __new__(cls, *, x: _Floats, y: _Floats, before: _Floats, after: _Floats) -> Curve: ...

@final
class Periodic:
    """A function that repeats with an angle [rad], by value, slope and bend at even knots from zero on."""

    def __new__(cls, *, period: float, value: _Floats, slope: _Floats, bend: _Floats) -> Periodic: ...

@final
class TorsionMass:
    """Discs that move as one: constant inertia [kg m²], damping against the ground, and that of swings.

    The latter resists what goes beyond the rigid-body speed of the train [N m s/rad]. What does not turn with
    the train rests while it runs.
    """

    def __new__(
        cls, *, inertia: float, damping: float, swing_damping: float, turns: bool = True
    ) -> TorsionMass: ...
    inertia: Final[float]
    damping: Final[float]
    swing_damping: Final[float]
    turns: Final[bool]

@final
class TorsionLink:
    """What twists between two masses, None for the ground, as seen at a part `ratio` times as fast.

    Stiffness [N m/rad], damping [N m s/rad], torque over twist in addition [N m, rad]. `rigid`: its ends move
    as one; `contact`: damping acts while flanks touch; `loss`: torque at the first end over that of the teeth
    while that end drives, and while the other does; `joint`: cos α and phase [rad] of a Hooke's joint at the
    first end; `carrier`: mass that carries a mesh, with the parts of all three angles in the twist.
    """

    def __new__(
        cls,
        *,
        first: int | None,
        second: int | None,
        ratio: float,
        stiffness: float,
        damping: float,
        curve: Curve | None,
        rigid: bool = False,
        contact: bool = False,
        loss: tuple[float, float] | None = None,
        joint: tuple[float, float] | None = None,
        carrier: tuple[int, Sequence[float]] | None = None,
    ) -> TorsionLink: ...
    first: Final[int | None]
    second: Final[int | None]
    ratio: Final[float]
    stiffness: Final[float]
    damping: Final[float]
    curve: Final[Curve | None]
    rigid: Final[bool]
    contact: Final[bool]
    loss: Final[tuple[float, float] | None]
    joint: Final[tuple[float, float] | None]
    carrier: Final[tuple[int, Sequence[float]] | None]

@final
class TorsionPendulum:
    """Centrifugal pendulums [kg, m] on a disc `ratio` times as fast as its mass; the mass of their angle."""

    def __new__(
        cls, *, disc: int, bob: int, ratio: float, mass: float, radius: float, length: float
    ) -> TorsionPendulum: ...
    disc: Final[int]
    bob: Final[int]
    ratio: Final[float]
    mass: Final[float]
    radius: Final[float]
    length: Final[float]

@final
class TorsionController:
    """A PI controller of the speed of a mass, and the mass whose speed its integral is.

    Gain [N m s/rad], one over the integral-action time [1/s], torque without deviation and limit [N m], speed
    wanted over time [rad/s, s].
    """

    def __new__(
        cls,
        *,
        mass: int,
        integral: int,
        ratio: float,
        gain: float,
        inverse_time: float,
        offset: float,
        limit: float,
        set_point: Curve,
    ) -> TorsionController: ...
    mass: Final[int]
    integral: Final[int]
    ratio: Final[float]
    gain: Final[float]
    inverse_time: Final[float]
    offset: Final[float]
    limit: Final[float]
    set_point: Final[Curve]

@final
class TorsionRotor:
    """An inertia [kg m²] over the angle [rad] of a part `ratio` times as fast as its mass."""

    def __new__(cls, *, mass: int, ratio: float, phase: float, inertia: Periodic) -> TorsionRotor: ...
    mass: Final[int]
    ratio: Final[float]
    phase: Final[float]
    inertia: Final[Periodic]

class TorqueLaw:
    """How a torque depends on the speed of its part, or on time."""

    @final
    class Constant(TorqueLaw):
        """Not at all."""

        __match_args__: Final = ()

        def __new__(cls) -> TorqueLaw.Constant: ...

    @final
    class Even(TorqueLaw):
        """|ω/ω₀|ᵖ, the same in both senses."""

        __match_args__: Final = ("speed", "exponent")

        def __new__(cls, *, speed: float, exponent: float) -> TorqueLaw.Even: ...
        speed: Final[float]
        exponent: Final[float]

    @final
    class Odd(TorqueLaw):
        """|ω/ω₀|ᵖ with the sign of the speed."""

        __match_args__: Final = ("speed", "exponent")

        def __new__(cls, *, speed: float, exponent: float) -> TorqueLaw.Odd: ...
        speed: Final[float]
        exponent: Final[float]

    @final
    class OverSpeed(TorqueLaw):
        """A curve over the speed."""

        __match_args__: Final = ("curve",)

        def __new__(cls, *, curve: Curve) -> TorqueLaw.OverSpeed: ...
        curve: Final[Curve]

    @final
    class Following(TorqueLaw):
        """Gain [N m s/rad] times what the speed lacks of a curve over time."""

        __match_args__: Final = ("gain", "curve")

        def __new__(cls, *, gain: float, curve: Curve) -> TorqueLaw.Following: ...
        gain: Final[float]
        curve: Final[Curve]

    @final
    class Decaying(TorqueLaw):
        """A sine of angular frequency `speed` that decays at a rate [1/s], between two times [s]."""

        __match_args__: Final = ("start", "end", "rate", "speed", "phase")

        def __new__(
            cls, *, start: float, end: float, rate: float, speed: float, phase: float
        ) -> TorqueLaw.Decaying: ...
        start: Final[float]
        end: Final[float]
        rate: Final[float]
        speed: Final[float]
        phase: Final[float]

@final
class TorqueShape:
    """How a torque depends on the angle: `pitch`, angle of the table over that of the mass; phase [rad]."""

    def __new__(cls, *, table: Periodic, pitch: float, phase: float) -> TorqueShape: ...
    table: Final[Periodic]
    pitch: Final[float]
    phase: Final[float]

@final
class TorsionTorque:
    """A torque on a part `ratio` times as fast as its mass: scale · weight(t) · law · shape [N m]."""

    def __new__(
        cls,
        *,
        mass: int,
        ratio: float,
        scale: float,
        law: TorqueLaw,
        weight: Curve | None,
        shape: TorqueShape | None,
    ) -> TorsionTorque: ...
    mass: Final[int]
    ratio: Final[float]
    scale: Final[float]
    law: Final[TorqueLaw]
    weight: Final[Curve | None]
    shape: Final[TorqueShape | None]

@final
class TorsionGrip:
    """Friction in one sense of slip, at full engagement.

    Static capacity, sliding torque far from rest and what it has more at rest [N m], slip at which that has
    fallen to 1/e [rad/s]; sliding torque over slip instead [N m, rad/s].
    """

    def __new__(
        cls, *, held: float, sliding: float, rise: float, speed: float, curve: Curve | None
    ) -> TorsionGrip: ...
    held: Final[float]
    sliding: Final[float]
    rise: Final[float]
    speed: Final[float]
    curve: Final[Curve | None]

@final
class TorsionFriction:
    """Dry friction between two masses, None for the ground, at a part `ratio` times as fast.

    Where the first end is faster and where it is slower, None where it cannot slide; engagement over time
    [s], None for 1.
    """

    def __new__(
        cls,
        *,
        first: int | None,
        second: int | None,
        ratio: float,
        forward: TorsionGrip | None,
        backward: TorsionGrip | None,
        engagement: Curve | None,
    ) -> TorsionFriction: ...
    first: Final[int | None]
    second: Final[int | None]
    ratio: Final[float]
    forward: Final[TorsionGrip | None]
    backward: Final[TorsionGrip | None]
    engagement: Final[Curve | None]

@final
class TorsionMotion:
    """A train's motion in time.

    How it ended and its method by name; steps, those rejected, evaluations; time reached [s], bound of the
    fastest swing [rad/s]; kinetic and potential energy at the start and at the end [J]; samples: angle and
    speed (masses, times) [rad, rad/s], torque (links, times) [N m], energies (times,) [J]; extremes of the
    torque of each link and the speed of each mass; work of each torque, losses in links and at masses [J].
    Of elements with friction: losses [J], torque (frictions, times) [N m], state (0 open, 1 stuck, 2 sliding
    forward, 3 backward), extremes of torque and power [W], how often it came to hold, how long it slid and
    held [s].
    """

    end: Final[str]
    method: Final[str]
    steps: Final[int]
    rejected: Final[int]
    evaluations: Final[int]
    time: Final[float]
    fastest: Final[float]
    kinetic_start: Final[float]
    potential_start: Final[float]
    kinetic_end: Final[float]
    potential_end: Final[float]
    angle: Final[_Floats]
    speed: Final[_Floats]
    torque: Final[_Floats]
    kinetic: Final[_Floats]
    potential: Final[_Floats]
    torque_extremes: Final[Extremes]
    speed_extremes: Final[Extremes]
    work: Final[_Floats]
    loss_links: Final[_Floats]
    loss_masses: Final[_Floats]
    loss_frictions: Final[_Floats]
    friction_torque: Final[_Floats]
    friction_state: Final[_Floats]
    friction_extremes: Final[Extremes]
    power_extremes: Final[Extremes]
    engagements: Final[list[int]]
    slip_time: Final[_Floats]
    stuck_time: Final[_Floats]

@final
class NetTorques:
    """Sum of torques on each mass [N m], and its inertia [kg m²], (rows, masses) each."""

    torque: Final[_Floats]
    inertia: Final[_Floats]

@final
class TorsionSystem:
    """A train in motion. IndexError: a mass that is spoken of is not there; ValueError: there is none."""

    def __new__(
        cls,
        *,
        masses: Sequence[TorsionMass],
        links: Sequence[TorsionLink],
        rotors: Sequence[TorsionRotor],
        torques: Sequence[TorsionTorque],
        pendulums: Sequence[TorsionPendulum] = ...,
        controllers: Sequence[TorsionController] = ...,
        frictions: Sequence[TorsionFriction] = ...,
    ) -> TorsionSystem: ...
    def follow(
        self,
        *,
        angle: _Floats,
        speed: _Floats,
        times: _Floats,
        start: float,
        duration: float,
        accuracy: float,
        method: str,
        steps_max: int,
    ) -> TorsionMotion:
        """The motion from angles and speeds of the masses, sampled at times."""

    def net_torques(self, t: float, angle: _Floats, speed: _Floats) -> NetTorques:
        """Sum of torques on each mass and its inertia at rows of angles (rows, masses)."""
