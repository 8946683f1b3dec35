r"""Motors: torque against speed of the motor shaft.

| kind | characteristic |
| --- | --- |
| `induction` | Kloss's formula, through the breakdown point |
| `dc` | straight line from stall to no load |
| `table` | linear between given points, constant outside |
| `constant_torque` | the same torque at any speed |
| `constant_speed` | the same speed under any load |

Catalogues seldom print the breakdown speed of an induction motor. It follows from the rated point. With the
slip :math:`s = (\omega_0 - \omega)/\omega_0` and :math:`a = R_1/R_2'`, Kloss's formula

.. math:: M = \frac{2 M_k (1 + a s_k)}{s/s_k + s_k/s + 2 a s_k}

goes through :math:`(s_n, M_n)`, with :math:`\lambda = M_k/M_n`, for the larger root of

.. math:: s_k^2 (1/s_n + 2a - 2\lambda a) - 2\lambda s_k + s_n = 0

Entries that follow from others are completed when a motor is made; what was given is never changed.
"""

from collections.abc import Iterator, Mapping, Sequence
from typing import Annotated, Any, ClassVar, Literal, Self

import numpy as np
from pydantic import AfterValidator, Field, model_validator
from pydantic_core import InitErrorDetails

from linkwright.kernel.description.base import Description, fault, raise_faults
from linkwright.kernel.description.curve import curve_faults, unread_file
from linkwright.kernel.description.place import keys, look
from linkwright.kernel.numerics.tangent import plain
from linkwright.kernel.units.kinds import INERTIA, POWER, RATIO, SPEED, TORQUE
from linkwright.kernel.units.marks import Speeds, Torque, Torques, not_negative, positive

Values = dict[str, Any]

# Speeds [rad/s], torques [N m], and whether the line goes on beyond its ends.
Polyline = tuple[Sequence[Any], Sequence[Any], bool]
PositiveSpeed = Annotated[float, positive(SPEED)]
PositiveTorque = Annotated[float, positive(TORQUE)]
PositivePower = Annotated[float, positive(POWER)]

# Catalogues round: rated power, torque and speed of the types shipped here agree to 0.5 %. Ten times that is
# a slip of the pen.
_RATED_AGREE = 0.05


class Motor(Description):
    """What all motors have: an inertia, and a rated point that sizing compares with."""

    inertia: Annotated[float, not_negative(INERTIA)] = Field(
        0.0, description="Moment of inertia of the rotor, at its shaft."
    )
    power_rated: PositivePower | None = Field(None, description="Rated power at the shaft.")
    speed_rated: PositiveSpeed | None = Field(None, description="Speed at the rated point.")
    torque_rated: PositiveTorque | None = Field(None, description="Torque at the rated point.")

    # What the speed at zero torque is called; empty for a motor that has none.
    no_load_word: ClassVar[str] = ""
    # A sentence on its characteristic, for the assumptions of a report.
    sentence: ClassVar[str] = ""

    @property
    def speed_without_load(self) -> Any:
        """Speed of zero torque, or the one that the motor keeps [rad/s]; None if it has none."""
        return None

    def polyline(self) -> Polyline | None:
        """Its characteristic as straight lines, constant outside or endless; None where it is curved."""
        return None

    @model_validator(mode="before")
    @classmethod
    def _kind_of_catalogue(cls, data: Any) -> Any:
        if "catalogue" in keys(data) and "catalogue" not in cls.model_fields:
            remedy = 'leave it out, or give a type of your own with file = "motors.csv"'
            expected = "nothing: the types of the catalogue are induction motors"
            raise_faults(
                cls.__name__,
                [fault("catalogue", found=look(data, "catalogue"), expected=expected, remedy=remedy)],
            )
        return data

    @model_validator(mode="after")
    def _complete_and_check(self) -> Self:
        """Fill in what follows from the given entries; report what contradicts itself."""
        self._fill()
        raise_faults(type(self).__name__, self._faults())
        return self

    def with_entries(self, entries: Mapping[str, Any]) -> Self:
        """Copy with some entries exchanged, unchecked; what follows from them is computed anew."""
        copy = super().with_entries(entries)
        copy._fill()
        return copy

    def _fill(self) -> None:
        given = {name: getattr(self, name) for name in self.model_fields_set}
        for name, value in self._completed({k: v for k, v in given.items() if v is not None}).items():
            # The model is frozen for its users; these entries are part of making it.
            object.__setattr__(self, name, value)

    @classmethod
    def _completed(cls, given: Values) -> Values:
        """The given entries with all that follows from them; plain arithmetic, so arrays will do."""
        return with_rated_point(given)

    def _faults(self) -> Iterator[InitErrorDetails]:
        if self.power_rated is None or self.torque_rated is None or self.speed_rated is None:
            return
        power = self.torque_rated * self.speed_rated
        if abs(power - self.power_rated) > _RATED_AGREE * self.power_rated:
            yield fault(
                "power_rated",
                found=f"{self.power_rated:.6g} W",
                expected=f"the rated torque times the rated speed, {power:.6g} W",
                remedy="leave one of the three out",
            )


def with_rated_point(given: Values) -> Values:
    """Add the rated torque or the rated power, whichever is missing, by P = M ω."""
    power, torque, speed = (given.get(f"{name}_rated") for name in ("power", "torque", "speed"))
    if torque is None and power is not None and speed is not None:
        return given | {"torque_rated": power / speed}
    if power is None and torque is not None and speed is not None:
        return given | {"power_rated": torque * speed}
    return given


def breakdown_slip(slip_rated: Any, overload: Any, resistance_ratio: Any) -> Any:
    """Slip at which Kloss's formula through the rated point has its maximum torque.

    `slip_rated`: s_n, slip at the rated point; `overload`: λ = M_k/M_n, breakdown over rated torque; greater
    than 1; `resistance_ratio`: a = R_1/R_2'; 0 is Kloss's simplified formula. Returns: s_k; NaN if no formula
    of this kind goes through the point.
    """
    s_n, lam, a = slip_rated, overload, resistance_ratio
    # Where no formula goes through the point, and beyond the range of floats, there is no slip.
    with np.errstate(all="ignore"):
        square = np.divide(1.0, s_n) + 2 * a - 2 * lam * a
        slip = np.where(square > 0, (lam + np.sqrt(lam * lam - square * s_n)) / square, np.nan)
    return slip if slip.ndim else plain(slip)


def _coincide(first: Any, second: Any) -> bool:
    """Whether two entries are one number; rows of many machines have no answer of their own there."""
    return not np.ndim(first) and not np.ndim(second) and bool(first == second)


def _known_type(type: str) -> str:
    from linkwright.drive.model import catalogue

    return catalogue.checked_name(type)


def _of_catalogue(given: Values) -> Values:
    """What the type gives, if there is one; no pull-up where the file has a start of its own."""
    from linkwright.drive.model import catalogue

    if given.get("catalogue") is None:
        return {}
    known = catalogue.entries(given["catalogue"])
    has_start = any(name in given for name in catalogue.START)
    return {name: value for name, value in known.items() if not (has_start and name in catalogue.START[1:])}


CatalogueName = Annotated[str, AfterValidator(_known_type)]


class InductionMotor(Motor):
    """Three-phase induction motor with a cage rotor, by Kloss's formula."""

    kind: Literal["induction"]
    no_load_word: ClassVar[str] = "synchronous"
    catalogue: CatalogueName | None = Field(
        None,
        description="Type in the catalogue of motors; its data supply missing entries. A missing "
        "rotor inertia is estimated by similarity.",
    )
    file: str | None = Field(
        None,
        description='CSV file of motors, in which `catalogue` names the type; units in the header: "type, '
        'power_rated [kW], speed_rated [rpm], torque_breakdown_ratio".',
    )
    speed_synchronous: PositiveSpeed | None = Field(None, description="Speed at zero torque.")
    torque_breakdown: PositiveTorque | None = Field(None, description="Maximum torque.")
    speed_breakdown: PositiveSpeed | None = Field(
        None, description="Speed at breakdown torque. Default: from the rated point."
    )
    torque_start: PositiveTorque | None = Field(
        None, description="Starting torque. Default: Kloss's formula applies down to standstill."
    )
    torque_pull_up: PositiveTorque | None = Field(
        None, description="Minimum torque between standstill and breakdown."
    )
    speed_pull_up: PositiveSpeed | None = Field(None, description="Speed of the pull-up torque.")
    resistance_ratio: Annotated[float, not_negative(RATIO)] = Field(
        0.0, description="Ratio of stator to referred rotor resistance; 0 gives Kloss's simplified formula."
    )

    @property
    def speed_without_load(self) -> Any:
        """Synchronous speed [rad/s]."""
        return self.speed_synchronous

    @property
    def breakdown_is_minimum(self) -> bool:
        """Whether the breakdown torque is the minimum of standards, as neither file nor catalogue has it."""
        from linkwright.drive.model import catalogue

        given = self.catalogue is None or "torque_breakdown" in self.model_fields_set
        return not given and catalogue.motor(str(self.catalogue)).breakdown_is_minimum

    @property
    def inertia_is_estimated(self) -> bool:
        """Whether the rotor's inertia is estimated, as neither file nor catalogue has it."""
        from linkwright.drive.model import catalogue

        given = self.catalogue is None or "inertia" in self.model_fields_set
        return not given and catalogue.motor(str(self.catalogue)).inertia is None

    @property
    def start_is_minimum(self) -> bool:
        """Whether file and catalogue lack the starting torque, so that the minimum of standards counts."""
        from linkwright.drive.model import catalogue

        given = self.catalogue is None or any(name in self.model_fields_set for name in catalogue.START)
        return not given and catalogue.motor(str(self.catalogue)).start_is_minimum

    @classmethod
    def _completed(cls, given: Values) -> Values:
        values = with_rated_point(given)
        if known := _of_catalogue(given):
            values = with_rated_point(known | values)
        return with_breakdown_speed(values)

    def _faults(self) -> Iterator[InitErrorDetails]:
        yield from super()._faults()
        if self.file is not None:
            yield unread_file(self.file)
            return
        yield from self._idle_type()
        missing = list(self._missing())
        yield from missing or self._out_of_order()
        yield from self._start_faults()

    def _idle_type(self) -> Iterator[InitErrorDetails]:
        """A catalogue type beside a complete characteristic, where it would have no effect."""
        given = {name: getattr(self, name) for name in self.model_fields_set}
        known = _of_catalogue(given)
        if known and not {*known} - {*with_rated_point(given), "inertia"}:
            own = ", ".join(name for name in type(self).model_fields if name in given and name in known)
            expected = f"nothing beside {own}, which replace all its data"
            yield fault(
                "catalogue", found=self.catalogue, expected=expected, remedy="remove one or the other"
            )

    def _missing(self) -> Iterator[InitErrorDetails]:
        by_catalogue = f', which the catalogue does not give for "{self.catalogue}"' if self.catalogue else ""
        if self.speed_synchronous is None:
            yield fault("speed_synchronous", expected=f"the synchronous speed{by_catalogue}")
        if self.torque_breakdown is None:
            yield fault("torque_breakdown", expected=f"the breakdown torque{by_catalogue}")
        if self.speed_breakdown is None and (self.speed_rated is None or self.torque_rated is None):
            yield fault(
                "speed_breakdown",
                expected="the breakdown speed, or the rated speed and the rated torque or power",
            )

    def _out_of_order(self) -> Iterator[InitErrorDetails]:
        """Points of the characteristic that are not in their order, 0 < breakdown < rated < synchronous."""
        top, knee, rated = self.speed_synchronous, self.speed_breakdown, self.speed_rated
        if top is None or self.torque_breakdown is None:
            return
        if self.torque_rated is not None and self.torque_rated >= self.torque_breakdown:
            yield _less("torque_rated", self.torque_rated, "the breakdown torque", self.torque_breakdown)
        if rated is not None and rated >= top:
            yield _less("speed_rated", rated, "the synchronous speed", top)
        if knee is not None and "speed_breakdown" in self.model_fields_set:
            yield from _knee_faults(knee, rated, top)
        elif (rated is None or rated < top) and (knee is None or not 0 < knee < top):
            yield self._no_formula()
        elif knee is not None and self.resistance_ratio * (top - knee) >= top:
            # R1/√(R1² + X²) is less than 1; beyond, the formula has a pole where the motor brakes.
            limit = f"less than {top / (top - knee):.4g}, one over the breakdown slip"
            yield fault("resistance_ratio", found=f"{self.resistance_ratio:.6g}", expected=limit)

    def _no_formula(self) -> InitErrorDetails:
        return fault(
            "speed_breakdown",
            expected="a rated point with less torque than the breakdown torque, and a small slip",
            remedy="no breakdown speed between 0 and the synchronous speed fits the rated point",
        )

    def _start_faults(self) -> Iterator[InitErrorDetails]:
        start, pull, peak = self.torque_start, self.torque_pull_up, self.torque_breakdown
        if start is not None and peak is not None and start > peak:
            yield fault(
                "torque_start",
                found=f"{start:.6g} N m",
                expected=f"at most the breakdown torque, {peak:.6g} N m",
                remedy="the breakdown torque is the maximum torque of the characteristic",
            )
        if pull is None and self.speed_pull_up is None:
            return
        yield from self._pull_up_faults()

    def _pull_up_faults(self) -> Iterator[InitErrorDetails]:
        for name in ("torque_pull_up", "speed_pull_up", "torque_start"):
            if getattr(self, name) is None:
                remedy = "the pull-up point needs its torque, its speed and the starting torque"
                yield fault(name, expected=f"{name}, because a pull-up point is given", remedy=remedy)
        pull, speed = self.torque_pull_up, self.speed_pull_up
        limits = (("starting", self.torque_start), ("breakdown", self.torque_breakdown))
        for word, limit in limits:
            if pull is not None and limit is not None and pull > limit:
                yield fault(
                    "torque_pull_up",
                    found=f"{pull:.6g} N m",
                    expected=f"at most the {word} torque, {limit:.6g} N m",
                )
        if speed is not None and self.speed_breakdown is not None and speed >= self.speed_breakdown:
            yield _less("speed_pull_up", speed, "the breakdown speed", self.speed_breakdown)


def with_breakdown_speed(given: Values) -> Values:
    """Add the breakdown speed, if it is missing and the rated point is there."""
    needs = ("speed_synchronous", "speed_rated", "torque_rated", "torque_breakdown")
    if "speed_breakdown" in given or any(name not in given for name in needs):
        return given
    omega_0, omega_n, M_n, M_k = (given[name] for name in needs)
    # A torque of zero is what is left of a power below the smallest numbers.
    if _coincide(omega_n, omega_0) or _coincide(M_n, 0.0):
        return given
    s_k = breakdown_slip((omega_0 - omega_n) / omega_0, M_k / M_n, given.get("resistance_ratio", 0.0))
    return given | {"speed_breakdown": omega_0 * (1 - s_k)}


def _knee_faults(knee: float, rated: float | None, top: float) -> Iterator[InitErrorDetails]:
    if knee >= top:
        yield _less("speed_breakdown", knee, "the synchronous speed", top)
    elif rated is not None and knee >= rated:
        yield _less("speed_breakdown", knee, "the rated speed", rated)


def _less(key: str, value: float, word: str, limit: float) -> InitErrorDetails:
    unit = "N m" if key.startswith("torque") else "rad/s"
    return fault(key, found=f"{value:.6g} {unit}", expected=f"less than {word}, {limit:.6g} {unit}")


class DcMotor(Motor):
    """Direct-current motor with constant excitation: M = M_stall (1 − ω/ω_0).

    Within ± the maximum torque that the limit of its current allows.
    """

    kind: Literal["dc"]
    no_load_word: ClassVar[str] = "no-load"
    sentence: ClassVar[str] = "The motor torque falls linearly from standstill to the no-load speed."
    speed_no_load: PositiveSpeed = Field(description="Speed at zero torque.")
    torque_stall: PositiveTorque | None = Field(
        None, description="Stall torque. Default: from the rated point."
    )
    torque_max: PositiveTorque | None = Field(
        None,
        description="Maximum torque by the current limit, driving or braking. Default: no limit.",
    )

    @property
    def speed_without_load(self) -> Any:
        """Speed of zero torque [rad/s]."""
        return self.speed_no_load

    def polyline(self) -> Polyline:
        """From standstill to no load and on; held at both ends where the current has a limit.

        The first speed is then negative where the limit exceeds the stall torque.
        """
        assert self.torque_stall is not None
        if self.torque_max is None:
            return (0.0, self.speed_no_load), (self.torque_stall, 0.0), True
        share = self.torque_max / self.torque_stall
        speeds = (self.speed_no_load * (1 - share), self.speed_no_load * (1 + share))
        return speeds, (self.torque_max, -self.torque_max), False

    @classmethod
    def _completed(cls, given: Values) -> Values:
        values = with_rated_point(given)
        needs = ("speed_no_load", "speed_rated", "torque_rated")
        if "torque_stall" in values or any(name not in values for name in needs):
            return values
        omega_0, omega_n, M_n = (values[name] for name in needs)
        if _coincide(omega_n, omega_0):
            return values
        with np.errstate(divide="ignore", invalid="ignore", over="ignore"):
            return values | {"torque_stall": M_n / (1 - omega_n / omega_0)}

    def _faults(self) -> Iterator[InitErrorDetails]:
        yield from super()._faults()
        if self.speed_rated is not None and self.speed_rated >= self.speed_no_load:
            yield _less("speed_rated", self.speed_rated, "the no-load speed", self.speed_no_load)
        elif self.torque_stall is None:
            yield fault(
                "torque_stall", expected="the stall torque, or the rated speed and the rated torque or power"
            )
        most, rated = self.torque_max, self.torque_rated
        if most is not None and rated is not None and most < rated:
            expected = f"at least the rated torque, {rated:.6g} N m"
            yield fault("torque_max", found=f"{most:.6g} N m", expected=expected)


class TableMotor(Motor):
    """Motor whose torque is given at some speeds; linear between them and constant outside."""

    kind: Literal["table"]
    sentence: ClassVar[str] = "The motor torque is linear between the given speeds and constant outside them."
    speed: Speeds = Field(description="Speeds of the motor shaft, increasing.")
    torque: Torques = Field(description="Torque at each speed.")

    def polyline(self) -> Polyline:
        """The given points."""
        return self.speed, self.torque, False

    def _faults(self) -> Iterator[InitErrorDetails]:
        yield from super()._faults()
        yield from curve_faults(self, "speed", ("torque",))


class ConstantTorqueMotor(Motor):
    """Motor that gives the same torque at any speed."""

    kind: Literal["constant_torque"]
    sentence: ClassVar[str] = "The motor gives the same torque at any speed."
    torque: Torque = Field(description="Torque at the motor shaft.")

    def polyline(self) -> Polyline:
        """One torque at all speeds."""
        return (0.0,), (self.torque,), False


class ConstantSpeedMotor(Motor):
    """Motor that keeps its speed under any load."""

    kind: Literal["constant_speed"]
    sentence: ClassVar[str] = (
        "The motor keeps its speed under any load; the driving torque follows from the motion."
    )
    speed: PositiveSpeed = Field(description="Speed of the motor shaft.")

    @property
    def speed_without_load(self) -> Any:
        """The speed that it keeps [rad/s]."""
        return self.speed


AnyMotor = Annotated[
    InductionMotor | DcMotor | TableMotor | ConstantTorqueMotor | ConstantSpeedMotor,
    Field(discriminator="kind"),
]
