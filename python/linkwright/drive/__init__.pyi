"""What others use of this room; `__init__.py` loads it on first use."""

from linkwright.drive.batch import FAST_STARTS as FAST_STARTS
from linkwright.drive.batch import STATUS as STATUS
from linkwright.drive.batch import SteadyStates as SteadyStates
from linkwright.drive.evenness import constant_energy_of as constant_energy_of
from linkwright.drive.gradient import gradient_along as gradient_along
from linkwright.drive.gradient import solved_along as solved_along
from linkwright.drive.model.catalogue import OVERLOAD as OVERLOAD
from linkwright.drive.model.catalogue import CatalogueMotor as CatalogueMotor
from linkwright.drive.model.catalogue import estimated_inertia as estimated_inertia
from linkwright.drive.model.catalogue import motor as motor
from linkwright.drive.model.drive import Drive as Drive
from linkwright.drive.model.motor import ConstantSpeedMotor as ConstantSpeedMotor
from linkwright.drive.model.motor import ConstantTorqueMotor as ConstantTorqueMotor
from linkwright.drive.model.motor import DcMotor as DcMotor
from linkwright.drive.model.motor import InductionMotor as InductionMotor
from linkwright.drive.model.motor import TableMotor as TableMotor
from linkwright.drive.motion_events import course as course
from linkwright.drive.motion_events import states as states
from linkwright.drive.run_up import accurate_run_down as accurate_run_down
from linkwright.drive.run_up import accurate_run_up as accurate_run_up
from linkwright.drive.steady_state import SteadyState as SteadyState
from linkwright.drive.step_method import whole_steps as whole_steps
from linkwright.drive.transient import End as End
from linkwright.drive.transient import Transient as Transient
