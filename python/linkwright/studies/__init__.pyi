"""What others use of this room; `__init__.py` loads it on first use."""

from linkwright.studies.cams import Levels as Levels
from linkwright.studies.cams import cam_search_study as cam_search_study
from linkwright.studies.cams import kept as kept
from linkwright.studies.commands.sweep import shown_of as shown_of
from linkwright.studies.figures import StudyRows as StudyRows
from linkwright.studies.folder import opened as opened
from linkwright.studies.knives import field_study as field_study
from linkwright.studies.model import Distribution as Distribution
from linkwright.studies.parquet import columns_of as columns_of
from linkwright.studies.plan import StudyPlan as StudyPlan
from linkwright.studies.sizes import cam_study as cam_study
from linkwright.studies.sizes import damper_study as damper_study
from linkwright.studies.sizes import drive_study as drive_study
