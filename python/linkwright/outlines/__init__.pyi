"""What others use of this room; `__init__.py` loads it on first use."""

from linkwright.outlines.model.section import Section as Section
from linkwright.outlines.model.section import section_of as section_of
from linkwright.outlines.plate import PlateProperties as PlateProperties
from linkwright.outlines.plate import outline as outline
from linkwright.outlines.solid import plate_solid as plate_solid
