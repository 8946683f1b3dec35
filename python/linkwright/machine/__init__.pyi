"""What others use of this room; `__init__.py` loads it on first use."""

from linkwright.machine.address import exchanged as exchanged
from linkwright.machine.address import kind as kind
from linkwright.machine.file_argument import File as File
from linkwright.machine.program.compiled import CompiledMachine as CompiledMachine
from linkwright.machine.program.compiled import compile_machine as compile_machine
from linkwright.machine.program.core import NoSteadyMotion as NoSteadyMotion
from linkwright.machine.program.core import Status as Status
from linkwright.machine.program.core import SteadyMotion as SteadyMotion
from linkwright.machine.program.drive_line import drive_inertia as drive_inertia
from linkwright.machine.read import read_as as read_as
from linkwright.machine.size_limits import size_and_limits as size_and_limits
from linkwright.machine.table import machine_parts as machine_parts
from linkwright.machine.tangents import directions as directions
from linkwright.machine.tolerances import tolerance_names as tolerance_names
from linkwright.machine.write import dumps as dumps
from linkwright.machine.write import in_own_units as in_own_units
