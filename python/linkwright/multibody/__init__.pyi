"""What others use of this room; `__init__.py` loads it on first use."""

from linkwright.multibody.export import Mjcf as Mjcf
from linkwright.multibody.export import Urdf as Urdf
from linkwright.multibody.export import mjcf as mjcf
from linkwright.multibody.export import urdf as urdf
from linkwright.multibody.transmission import JointMotion as JointMotion
from linkwright.multibody.transmission import Transmission as Transmission
