"""An export as tables: the model, its bodies, and what stands for motor and loads."""

from __future__ import annotations

from linkwright.kernel.page.table import Row, Table, row
from linkwright.multibody.export import Mjcf, Urdf

_SOLVER = ("step", "time_constant", "impedance", "armature", "speed_start")


def export_tables(made: Mjcf | Urdf) -> list[Table]:
    """Size and numbers of the model, and its joints."""
    rows: list[Row] = [
        ("bodies", "", str(len(made.bodies))),
        ("joints", "", ", ".join(made.joints)),
        ("closed loops", "", ", ".join(made.loops) or "–"),
    ]
    if isinstance(made, Mjcf):
        rows.append(("motor and loads", "", ", ".join(made.loads) or "–"))
        rows += [row(made, name)[:3] for name in _SOLVER]
    return [Table("export", "Model", ("quantity", "", "value"), rows)]
