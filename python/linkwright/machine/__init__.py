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

from linkwright.cam.model.cam import Cam, SecondFollower
from linkwright.cam.model.follower_train import FollowerTrain
from linkwright.cam.model.motion_law import (
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
from linkwright.cam.model.motion_section import MotionSection
from linkwright.cam.model.point_law import SplineLaw, TableLaw
from linkwright.drive.model.catalogue import CatalogueMotor, motor, motors
from linkwright.drive.model.drive import Brake, Coupling, Drive, Flywheel, Gearbox
from linkwright.drive.model.motor import (
    AnyMotor,
    ConstantSpeedMotor,
    ConstantTorqueMotor,
    DcMotor,
    InductionMotor,
    Motor,
    TableMotor,
)
from linkwright.kinetostatics.model.body import Body
from linkwright.kinetostatics.model.loads import AnyLoad
from linkwright.kinetostatics.model.loads.base import Load
from linkwright.kinetostatics.model.loads.between import (
    Damper,
    GasSpring,
    Spring,
    TorsionalDamper,
    TorsionalSpring,
)
from linkwright.kinetostatics.model.loads.force import ConstantForce, ConstantTorque, Gravity
from linkwright.kinetostatics.model.loads.formula import FormulaLoad
from linkwright.kinetostatics.model.loads.friction import DryFriction, ViscousFriction
from linkwright.kinetostatics.model.loads.table import ForcePosition, TorqueAngle, TorqueSpeed
from linkwright.linkages.model.element import (
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
from linkwright.linkages.model.mechanism import Link, Mechanism
from linkwright.machine.address import addresses, get, kind, replace
from linkwright.machine.machine import FORMAT, Machine, RunUp
from linkwright.pumping.model.polished_rod_load import PolishedRodLoad
from linkwright.pumping.model.rod_rotator import RodRotator
from linkwright.pumping.model.unit import PumpingUnit
from linkwright.pumping.model.unit_catalogue import CatalogueUnit, catalogue_unit, pumping_units
from linkwright.topping.model.field import MeasuredField, RandomField
from linkwright.topping.model.limits import TopperLimits
from linkwright.topping.model.motion import ConstantKnife, HarmonicKnife, MemberKnife
from linkwright.topping.model.scatter import ConstantScatter, LognormalScatter, NormalScatter, UniformScatter
from linkwright.topping.model.topper import Topper
from linkwright.torsion.model.coupling import Coupling as TrainCoupling
from linkwright.torsion.model.damper import Damper as TrainDamper
from linkwright.torsion.model.engine.combustion import Combustion
from linkwright.torsion.model.engine.engine import ReciprocatingEngine
from linkwright.torsion.model.engine.gas_load import ConstantGasLoad, PropellerGasLoad, TableGasLoad
from linkwright.torsion.model.engine.indicator import Indicator
from linkwright.torsion.model.engine.rod import ArticulatedRod, Rod
from linkwright.torsion.model.engine.swing_test import Swing, Swings, TwoPointSwing
from linkwright.torsion.model.engine.throw import (
    Counterweight,
    CrankPin,
    CrankThrow,
    CrankWeb,
    Drilling,
    Journal,
)
from linkwright.torsion.model.engine.valves import Valves
from linkwright.torsion.model.engine.wall_heat import HeatShare, Hohenberg, Woschni
from linkwright.torsion.model.engine.wiebe import Wiebe
from linkwright.torsion.model.shaft_limit import ShaftLimit
from linkwright.torsion.model.shaft_section import ShaftSection
from linkwright.torsion.model.train import Disc, ElasticShaft, Shaft, Train, TrainGear
from linkwright.torsion.model.train_event import (
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
from linkwright.torsion.model.train_run import TrainRun
from linkwright.torsion.model.train_torques import Excitation, Harmonic, LoadHarmonic, TrainLoad
from linkwright.torsion.model.train_transient import TrainMotor, TrainTransient

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
