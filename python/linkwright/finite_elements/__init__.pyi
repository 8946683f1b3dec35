"""What others use of this room; `__init__.py` loads it on first use."""

from linkwright.finite_elements.bending import bending_moments as bending_moments
from linkwright.finite_elements.loads import link_loads as link_loads
from linkwright.finite_elements.mesh import Mesh as Mesh
from linkwright.finite_elements.mesh import read_mesh as read_mesh
from linkwright.finite_elements.result import LinkLoad as LinkLoad
from linkwright.finite_elements.result import LinkLoads as LinkLoads
from linkwright.finite_elements.steps import Model as Model
from linkwright.finite_elements.steps import NodeSet as NodeSet
from linkwright.finite_elements.steps import step_text as step_text
