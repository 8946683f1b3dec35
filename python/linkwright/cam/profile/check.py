"""How many faults a cam has, as a number: what `linkwright.cam.profile.faults` says in sentences."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Annotated

from linkwright.cam.profile.faults import cam_faults
from linkwright.cam.profile.profile import cam_profile
from linkwright.kernel.quantities import Label
from linkwright.kernel.result import Result
from linkwright.machine.machine import Machine


@dataclass(frozen=True)
class CamCheck(Result):
    """Whether a cam can be made, in numbers."""

    n_faults: Annotated[int, Label("faults of the cam", "", "", "Empty if the cam can be manufactured.")]


def cam_check(machine: Machine, name: str | None = None) -> CamCheck:
    """Count what makes a cam impossible; `name`: left out if there is one. Raises as `cam_profile`."""
    return CamCheck(len(cam_faults(cam_profile(machine, name))))
