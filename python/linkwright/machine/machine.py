"""The machine: drive, mechanism, bodies, loads, and how it is run up."""

import math
from collections.abc import Iterator, Mapping, Sequence
from functools import cached_property
from typing import TYPE_CHECKING, Annotated, Any, Literal, Self

from pydantic import BaseModel, Field, ModelWrapValidatorHandler, ValidationError
from pydantic_core import InitErrorDetails

from linkwright.drive.model.drive import Drive, design_speed
from linkwright.kernel.description.base import Description, Name, Title, fault, faults_of, raise_faults
from linkwright.kernel.description.deferred_model import deferred_model
from linkwright.kernel.description.place import keys, look
from linkwright.kernel.description.problems import WholeDescription
from linkwright.kernel.units.kinds import RATIO, SPEED
from linkwright.kernel.units.marks import INSIDE_ONE, Angle, Quantity, not_negative, positive
from linkwright.kinetostatics.model.body import Body, body_faults
from linkwright.kinetostatics.model.loads import AnyLoad
from linkwright.kinetostatics.model.loads.references import load_faults
from linkwright.linkages.model.mechanism import Mechanism
from linkwright.machine.whole_mechanism import merged, topology_of, with_followers

if TYPE_CHECKING:
    from matplotlib.figure import Figure

    from linkwright.axes.model.axis import Axis, Master
    from linkwright.kernel.description.shown_units import ShownUnits
    from linkwright.linkages.model.drawing import DrawingPoints
    from linkwright.pumping.model.rod_rotator import RodRotator
    from linkwright.pumping.model.unit import PumpingUnit
    from linkwright.rods.model.rod_string import RodString
    from linkwright.studies.model import StudyFile
    from linkwright.topping.model.topper import Topper
    from linkwright.torsion.model.train import Train
    from linkwright.turning.model import TurningMoment
else:
    Master = deferred_model("axes.model.axis", "Master")
    Axis = deferred_model("axes.model.axis", "Axis")
    ShownUnits = deferred_model("kernel.description.shown_units", "ShownUnits")
    DrawingPoints = deferred_model("linkages.model.drawing", "DrawingPoints")
    PumpingUnit = deferred_model("pumping.model.unit", "PumpingUnit")
    RodRotator = deferred_model("pumping.model.rod_rotator", "RodRotator")
    RodString = deferred_model("rods.model.rod_string", "RodString")
    Topper = deferred_model("topping.model.topper", "Topper")
    Train = deferred_model("torsion.model.train", "Train")
    TurningMoment = deferred_model("turning.model", "TurningMoment")
    StudyFile = deferred_model("studies.model", "StudyFile")

# The format that this version reads and writes.
FORMAT = 1


class RunUp(Description):
    """How the run-up starts, and when it counts as done."""

    angle_start: Angle = Field(0.0, description="Crank angle at the start.")
    speed_start: Annotated[float, not_negative(SPEED)] = Field(
        0.0, description="Speed of the crankshaft at the start."
    )
    settled: Annotated[float, Quantity(RATIO, INSIDE_ONE)] = Field(
        0.01, description="Relative difference from the steady speed at which the run-up is complete."
    )
    turns_max: Annotated[float, positive(RATIO)] = Field(
        200.0, description="Maximum number of revolutions of the crankshaft in a run-up."
    )


class Machine(WholeDescription):
    """Complete description of a machine, in SI.

    Raises
    ------
    MachineError
        Something is wrong; all problems are listed, each with its key.
    """

    format: Literal[1] = Field(description="Version of the file format.")
    name: Title = Field(description="Name of the machine.")
    description: str = Field("", description="Description.")
    source: str = Field("", description="Source of the numbers.")
    drive: Drive | None = Field(None, description="Drive of the crankshaft.")
    drawing: DrawingPoints | None = Field(
        None,
        description="Coordinates of points; they give the lengths and positions that the mechanism does "
        "not. Reading replaces the drawing by these entries.",
    )
    mechanism: Mechanism = Field(
        default_factory=Mechanism,
        description="Mechanism on the crankshaft; with a pumping unit, further elements.",
    )
    master: Master | None = Field(
        None, description="Cycle of the machine, over whose angle cams and servo axes move."
    )
    axes: dict[Name, Axis] = Field(default_factory=dict, description="Servo axes by name.")
    pumping_unit: PumpingUnit | None = Field(
        None, description="Beam pumping unit, which is a mechanism by itself."
    )
    rod_rotator: RodRotator | None = Field(None, description="Rotator of the rod string on the pumping unit.")
    rod_string: RodString | None = Field(
        None, description="String of sucker rods below the polished rod, with its pump."
    )
    topper: Topper | None = Field(None, description="Knife that slices the heads of roots in a row.")
    train: Train | None = Field(None, description="Torsional system: discs, shafts and gears.")
    turning_moment: TurningMoment | None = Field(
        None, description="Turning-moment diagram of a shaft: torques over the angle, and a flywheel."
    )
    bodies: dict[str, Body] = Field(default_factory=dict, description="Masses by name.")
    loads: dict[Name, AnyLoad] = Field(default_factory=dict, description="Forces and torques by name.")
    run_up: RunUp = Field(default_factory=RunUp, description="Start and end of the run-up.")
    units: ShownUnits | None = Field(None, description="Units of tables, figures and CSV.")
    tolerances: dict[str, str] = Field(
        default_factory=dict,
        description='Tolerances by the address of the entry; a tolerance may also follow the value, "0.2 '
        'm ± 0.2 mm".',
    )
    study: StudyFile | None = Field(None, description="Study of variants: variables and responses.")

    @cached_property
    def as_given(self) -> Mapping[str, Any]:
        """Tables of the file that this machine was read from, as they stand there; empty without one."""
        return {}

    @property
    def linkage(self) -> Mechanism:
        """The whole mechanism: elements of the file, and those that cams and a pumping unit expand into."""
        own = with_followers(self.mechanism, self.axes, self.master, self.drive)
        return own if self.pumping_unit is None else merged(own, self.pumping_unit, self.rod_rotator)

    @property
    def design_speed(self) -> Any:
        """Speed of the crankshaft, of the master or of the cycle of a flow [rad/s]; None without it."""
        flowing = (part.cycle for part in self.mechanism.cylinders.values() if part.flow is not None)
        given = design_speed(self.master, self.drive)
        return next((2 * math.pi / cycle for cycle in flowing), None) if given is None else given

    @property
    def all_loads(self) -> dict[str, Any]:
        """Loads of the file by name, and those that cylinders stand for."""
        if not self.mechanism.cylinders:
            return self.loads
        from linkwright.kinetostatics.model.cylinder_loads import cylinder_loads

        parts = (cylinder_loads(name, cylinder) for name, cylinder in self.mechanism.cylinders.items())
        return self.loads | {name: load for part in parts for name, load in part.items()}

    def plot(self, *names: str, over: str | None = None) -> "Figure":
        """Curves by name as a figure, an axis for each unit.

        Without names the drawing of the machine, or what tells most of one without a linkage.

        Parameters
        ----------
        *names : str
            Curves as `linkwright plot` lists them, such as ``"ram.velocity"``.
        over : str, optional
            What they run over, such as ``"time"``; the crank angle without it.

        Returns
        -------
        matplotlib.figure.Figure
            A notebook shows it; ``figure.savefig(path)`` writes it.

        Raises
        ------
        InputError
            There is no such curve, or nothing to draw.
        """
        from linkwright.kernel.figure.figure_of import plotted_figure

        return plotted_figure(self, *names, over=over)

    def _repr_html_(self) -> str:
        from linkwright.kernel.page.notebook import table_html
        from linkwright.machine.table import machine_parts

        parts = machine_parts(self)
        rows = [
            (f"{part.group}: {part.name}" if part.name else part.group, entry.word, entry.value)
            for part in parts
            for entry in part.entries
        ]
        return table_html(self.name, rows)

    @property
    def twists(self) -> bool:
        """Whether it has shafts that twist: a train, or a driveline with an elastic part."""
        return self.train is not None or (self.drive is not None and self.drive.twists)

    @property
    def is_train_alone(self) -> bool:
        """Whether it is a torsional train and nothing else."""
        return self.train is not None and self.pumping_unit is None and _is_left_out(self)

    @property
    def has_mounted_mechanisms(self) -> bool:
        """Whether mechanisms stand on discs of its train."""
        return self.train is not None and bool(self.train.mechanisms)

    @property
    def is_topper_alone(self) -> bool:
        """Whether it is a topper whose knife moves by a law, and nothing else."""
        return self.topper is not None and self.pumping_unit is None and _is_left_out(self)

    @property
    def is_diagram_alone(self) -> bool:
        """Whether it is a turning-moment diagram and nothing else."""
        beside = (self.topper, self.train, self.pumping_unit)
        return self.turning_moment is not None and not any(beside) and _is_left_out(self)

    @property
    def is_rod_string_alone(self) -> bool:
        """Whether it is a rod string without a unit, and nothing else."""
        beside = (self.topper, self.train, self.pumping_unit, self.turning_moment)
        return self.rod_string is not None and not any(beside) and _is_left_out(self)

    @property
    def has_crank(self) -> bool:
        """Whether a crank moves a mechanism: not so in a train, topper, diagram or rod string alone."""
        alone = (self.is_train_alone, self.is_topper_alone, self.is_diagram_alone, self.is_rod_string_alone)
        return not any(alone)

    @classmethod
    def _checked(cls, data: Any, handler: ModelWrapValidatorHandler[Self]) -> Self:
        if isinstance(data, Mapping) and data.get("drawing") is not None:
            from linkwright.linkages.model.drawing import with_drawing

            drawn = with_drawing(data)
            raise_faults(cls.__name__, drawn.faults)
            data = drawn.tables
        try:
            machine = handler(data)
        except ValidationError as error:
            raise_faults(cls.__name__, [*faults_of(error), *_reference_faults(data)])
            raise
        raise_faults(cls.__name__, _reference_faults(machine))
        return machine


def _reference_faults(machine: object) -> list[InitErrorDetails]:
    mechanism, unit = look(machine, "mechanism"), look(machine, "pumping_unit")
    train, topper = look(machine, "train"), look(machine, "topper")
    faults = list(_faults_of_train(machine, train))
    diagram = look(machine, "turning_moment")
    string = look(machine, "rod_string")
    stands_alone = any(part is not None for part in (unit, train, topper, diagram, string))
    if not stands_alone and (mechanism is None or _is_left_out(machine)):
        return [fault("mechanism", expected="a table")]
    faults += _faults_of_unit(machine)
    if string is not None or unit is not None:
        from linkwright.rods.model.string_faults import string_faults

        faults += string_faults(machine)
    if not stands_alone and not isinstance(mechanism, BaseModel | Mapping):
        # There is nothing to refer to.
        return faults
    faults += _faults_of_axes(machine)
    topology = topology_of(machine)
    faults += _faults_of_topper(machine, topology.slides)
    bodies, loads = look(machine, "bodies"), look(machine, "loads")
    return [*faults, *body_faults(topology, bodies), *load_faults(topology, loads)]


def _faults_of_train(machine: object, train: object) -> Iterator[InitErrorDetails]:
    if train is not None:
        from linkwright.torsion.model.drive_train import two_trains
        from linkwright.torsion.model.train_faults import train_faults
        from linkwright.torsion.model.train_mechanism import mechanism_faults

        yield from train_faults(train)
        yield from two_trains(machine)
        yield from mechanism_faults(machine)


def _faults_of_unit(machine: object) -> Iterator[InitErrorDetails]:
    if look(machine, "pumping_unit") is not None or look(machine, "rod_rotator") is not None:
        from linkwright.pumping.model.expansion import expansion_faults

        yield from expansion_faults(machine)


def _faults_of_axes(machine: object) -> Iterator[InitErrorDetails]:
    mechanism = look(machine, "mechanism")
    moved = (look(mechanism, table) for table in ("linear_drivers", "cylinders"))
    if any(map(keys, (look(machine, "axes"), *moved))):
        from linkwright.axes.model.axis_faults import axes_faults

        yield from axes_faults(machine)


def _faults_of_topper(machine: object, slides: Sequence[str]) -> Iterator[InitErrorDetails]:
    if look(machine, "topper") is not None:
        from linkwright.topping.model.topper import topper_faults

        yield from topper_faults(machine, slides)


def _is_left_out(machine: object) -> bool:
    return isinstance(machine, BaseModel) and "mechanism" not in machine.model_fields_set
