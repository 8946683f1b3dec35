"""What a machine is: frozen descriptions in SI, checked, without any analysis.

| module | holds |
| --- | --- |
| `machine` | `Machine`: drive, mechanism, bodies, loads, run-up |
| `drive`, `drive_train` | gearbox, coupling, flywheel, brake; a drive line whose shafts twist, as a train |
| `motor` | the kinds of motor, and how their entries follow from one another |
| `catalogue` | published motors |
| `element` | cranks, dyads, gears, cables, joints and bars |
| `mechanism` | all elements by name |
| `cam`, `cam_follower`, `follower_train` | cams, their followers as drivers, and what vibrates behind them |
| `motion_section`, `motion_law`, `point_law` | sections of a cam's motion, and their laws |
| `follower_motion`, `section_faults` | the motion over a turn; what is wrong with sections |
| `assembly` | in which order a mechanism is built; what is missing or too much |
| `pumping_unit`, `polished_rod_load`, `rod_rotator` | beam pumping units, and the rotator of the rod string |
| `unit_catalogue` | published pumping units |
| `shaft_section`, `shaft_row` | sections of a shaft, and several in a row |
| `shaft_flexibility`, `shaft_step` | closed forms of cones and rings; what a step adds |
| `shaft_limit`, `propulsion_shaft`, `crankshaft_limit` | what shafts bear, given or by the rules of ships |
| `reciprocating/` | parts of reciprocating engines |
| `topper`, `topper_motion` | knives of root-crop toppers, and how they move |
| `topper_field`, `scatter`, `topper_limits` | roots of a field, lengths that scatter; limits of a knife |
| `train`, `train_speeds`, `train_faults` | torsional trains, speeds of their discs, faults |
| `train_transient`, `train_event` | manoeuvres of trains, what happens in them |
| `coupling`, `damper`, `train_torques`, `train_run` | couplings, dampers, torques on a train, its run |
| `whole_train` | engine, couplings and dampers written out as discs and shafts |
| `linkage` | the whole mechanism: elements of the file, and what cams and a pumping unit expand into |
| `body`, `loads` | masses; forces and torques |
| `formula` | formulas as texts |
| `curve` | curves given by points |
| `outline` | names in a mechanism: what refers to what, in which order it is built |
| `address`, `text` | entries by address |
| `base`, `plain` | what all descriptions share; reading checked and raw ones alike |
| `schema_walk`, `problems` | what belongs where; errors in the words of the file |
"""

from linkwright.machine.address import addresses, get, kind, replace
from linkwright.machine.body import Body
from linkwright.machine.cam import Cam, SecondFollower
from linkwright.machine.catalogue import CatalogueMotor, motor, motors
from linkwright.machine.coupling import Coupling as TrainCoupling
from linkwright.machine.damper import Damper as TrainDamper
from linkwright.machine.drive import Brake, Coupling, Drive, Flywheel, Gearbox
from linkwright.machine.element import (
    Bar,
    Cable,
    Crank,
    Crossing,
    FixedPoint,
    Gear,
    Guide,
    Joint,
    LinearDriver,
    Rack,
    RigidPoint,
    Rocker,
    Slider,
    SlottedLever,
    Yoke,
)
from linkwright.machine.follower_train import FollowerTrain
from linkwright.machine.loads import (
    AnyLoad,
    ConstantForce,
    ConstantTorque,
    Damper,
    DryFriction,
    ForcePosition,
    FormulaLoad,
    GasSpring,
    Gravity,
    Load,
    Spring,
    TorqueAngle,
    TorqueSpeed,
    TorsionalDamper,
    TorsionalSpring,
    ViscousFriction,
)
from linkwright.machine.machine import FORMAT, Machine, RunUp
from linkwright.machine.mechanism import Link, Mechanism
from linkwright.machine.motion_law import (
    CombinedLaw,
    LimitedLaw,
    ModifiedSineLaw,
    ModifiedTrapezoidLaw,
    OptimalLaw,
    PlainLaw,
    PolynomialLaw,
    SCurveLaw,
    TrapezoidalVelocityLaw,
)
from linkwright.machine.motion_section import MotionSection
from linkwright.machine.motor import (
    AnyMotor,
    ConstantSpeedMotor,
    ConstantTorqueMotor,
    DcMotor,
    InductionMotor,
    Motor,
    TableMotor,
)
from linkwright.machine.point_law import SplineLaw, TableLaw
from linkwright.machine.polished_rod_load import PolishedRodLoad
from linkwright.machine.pumping_unit import PumpingUnit
from linkwright.machine.reciprocating.combustion import Combustion
from linkwright.machine.reciprocating.engine import ReciprocatingEngine
from linkwright.machine.reciprocating.gas_load import ConstantGasLoad, PropellerGasLoad, TableGasLoad
from linkwright.machine.reciprocating.indicator import Indicator
from linkwright.machine.reciprocating.rod import ArticulatedRod, Rod
from linkwright.machine.reciprocating.swing_test import Swing, Swings, TwoPointSwing
from linkwright.machine.reciprocating.throw import (
    Counterweight,
    CrankPin,
    CrankThrow,
    CrankWeb,
    Drilling,
    Journal,
)
from linkwright.machine.reciprocating.valves import Valves
from linkwright.machine.reciprocating.wall_heat import HeatShare, Hohenberg, Woschni
from linkwright.machine.reciprocating.wiebe import Wiebe
from linkwright.machine.rod_rotator import RodRotator
from linkwright.machine.scatter import (
    ConstantScatter,
    LognormalScatter,
    NormalScatter,
    UniformScatter,
)
from linkwright.machine.shaft_limit import ShaftLimit
from linkwright.machine.shaft_section import ShaftSection
from linkwright.machine.topper import Topper
from linkwright.machine.topper_field import MeasuredField, RandomField
from linkwright.machine.topper_limits import TopperLimits
from linkwright.machine.topper_motion import ConstantKnife, HarmonicKnife, MemberKnife
from linkwright.machine.train import Disc, ElasticShaft, Shaft, Train, TrainGear
from linkwright.machine.train_event import (
    AnyTrainEvent,
    FuelSwitch,
    LoadStep,
    Misfire,
    MotorSwitch,
    ShortCircuit,
    SpeedCourse,
    TorqueCourse,
    TorqueStep,
)
from linkwright.machine.train_run import TrainRun
from linkwright.machine.train_torques import Excitation, Harmonic, LoadHarmonic, TrainLoad
from linkwright.machine.train_transient import TrainMotor, TrainTransient
from linkwright.machine.unit_catalogue import CatalogueUnit, catalogue_unit, pumping_units

__all__ = [
    "FORMAT",
    "AnyLoad",
    "AnyMotor",
    "AnyTrainEvent",
    "ArticulatedRod",
    "Bar",
    "Body",
    "Brake",
    "Cable",
    "Cam",
    "CatalogueMotor",
    "CatalogueUnit",
    "CombinedLaw",
    "Combustion",
    "ConstantForce",
    "ConstantGasLoad",
    "ConstantKnife",
    "ConstantScatter",
    "ConstantSpeedMotor",
    "ConstantTorque",
    "ConstantTorqueMotor",
    "Counterweight",
    "Coupling",
    "Crank",
    "CrankPin",
    "CrankThrow",
    "CrankWeb",
    "Crossing",
    "Damper",
    "DcMotor",
    "Disc",
    "Drilling",
    "Drive",
    "DryFriction",
    "ElasticShaft",
    "Excitation",
    "FixedPoint",
    "Flywheel",
    "FollowerTrain",
    "ForcePosition",
    "FormulaLoad",
    "FuelSwitch",
    "GasSpring",
    "Gear",
    "Gearbox",
    "Gravity",
    "Guide",
    "Harmonic",
    "HarmonicKnife",
    "HeatShare",
    "Hohenberg",
    "Indicator",
    "InductionMotor",
    "Joint",
    "Journal",
    "LimitedLaw",
    "LinearDriver",
    "Link",
    "Load",
    "LoadHarmonic",
    "LoadStep",
    "LognormalScatter",
    "Machine",
    "MeasuredField",
    "Mechanism",
    "MemberKnife",
    "Misfire",
    "ModifiedSineLaw",
    "ModifiedTrapezoidLaw",
    "MotionSection",
    "Motor",
    "MotorSwitch",
    "NormalScatter",
    "OptimalLaw",
    "PlainLaw",
    "PolishedRodLoad",
    "PolynomialLaw",
    "PropellerGasLoad",
    "PumpingUnit",
    "Rack",
    "RandomField",
    "ReciprocatingEngine",
    "RigidPoint",
    "Rocker",
    "Rod",
    "RodRotator",
    "RunUp",
    "SCurveLaw",
    "SecondFollower",
    "Shaft",
    "ShaftLimit",
    "ShaftSection",
    "ShortCircuit",
    "Slider",
    "SlottedLever",
    "SpeedCourse",
    "SplineLaw",
    "Spring",
    "Swing",
    "Swings",
    "TableGasLoad",
    "TableLaw",
    "TableMotor",
    "Topper",
    "TopperLimits",
    "TorqueAngle",
    "TorqueCourse",
    "TorqueSpeed",
    "TorqueStep",
    "TorsionalDamper",
    "TorsionalSpring",
    "Train",
    "TrainCoupling",
    "TrainDamper",
    "TrainGear",
    "TrainLoad",
    "TrainMotor",
    "TrainRun",
    "TrainTransient",
    "TrapezoidalVelocityLaw",
    "TwoPointSwing",
    "UniformScatter",
    "Valves",
    "ViscousFriction",
    "Wiebe",
    "Woschni",
    "Yoke",
    "addresses",
    "catalogue_unit",
    "get",
    "kind",
    "motor",
    "motors",
    "pumping_units",
    "replace",
]
