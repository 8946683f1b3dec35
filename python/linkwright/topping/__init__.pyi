"""What others use of this room; `__init__.py` loads it on first use."""

from linkwright.topping.charts import length_chart as length_chart
from linkwright.topping.coverage import Coverage as Coverage
from linkwright.topping.edge import Edge as Edge
from linkwright.topping.edge import edges_of as edges_of
from linkwright.topping.edge import require_topper as require_topper
from linkwright.topping.head_pass import HeadPass as HeadPass
from linkwright.topping.knife import Knife as Knife
from linkwright.topping.knife import knives as knives
from linkwright.topping.model.topper import Topper as Topper
from linkwright.topping.required_length import constant_speed_lengths as constant_speed_lengths
from linkwright.topping.required_length import length_consistent as length_consistent
from linkwright.topping.required_length import length_published as length_published
from linkwright.topping.required_length import published_lengths as published_lengths
from linkwright.topping.roots import cap_volume as cap_volume
from linkwright.topping.roots import draw_roots as draw_roots
from linkwright.topping.roots import head_diameter as head_diameter
from linkwright.topping.tables.topper import edge_csv as edge_csv
from linkwright.topping.topper import TopperStudy as TopperStudy
