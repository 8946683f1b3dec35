"""A mechanism on a disc of a train: a press, a pump, a conveyor, with its own machine file.

The crank of the mechanism turns with its disc, in the sense of the disc. Of its machine the mechanism, its
bodies and its loads count; the train has its own motors.
"""

from __future__ import annotations

from collections.abc import Iterator
from typing import Annotated, Any

from pydantic import Field
from pydantic_core import InitErrorDetails

from linkwright.kernel.description.base import Description, fault
from linkwright.kernel.description.deferred_model import DeferredModel
from linkwright.kernel.description.place import keys, look
from linkwright.kernel.units.marks import Angle

# A whole machine, which is described above the parts of a train.
MachineOfFile = Annotated[Any, DeferredModel("machine.machine", "Machine", is_file=True)]


class TrainMechanism(Description):
    """A mechanism whose crank turns with a disc."""

    on: str = Field(description="Disc that its crank turns with.")
    machine: MachineOfFile | None = Field(
        None,
        description='Machine file with the mechanism, its bodies and its loads, such as "press.toml", in the '
        "folder of the file or below it; its drive does not count. Default: [mechanism] of the file itself.",
    )
    phase: Angle = Field(0.0, description="Crank angle of the mechanism where the angle of its disc is zero.")


def mechanism_faults(machine: Any) -> Iterator[InitErrorDetails]:
    """Mechanisms of a train without a mechanism, and a motor that nothing of the train knows."""
    listed = look(look(machine, "train"), "mechanisms")
    own = [name for name in keys(listed) if look(look(listed, name), "machine") is None]
    has_own = "mechanism" in getattr(machine, "model_fields_set", keys(machine))
    has_own = has_own or look(machine, "pumping_unit") is not None
    for name in own:
        if not has_own:
            remedy = 'name its machine file, machine = "press.toml", or describe it as [mechanism]'
            yield fault("train", "mechanisms", name, "machine", expected="a mechanism", remedy=remedy)
    if keys(listed) and look(look(machine, "drive"), "motor") is not None:
        remedy = "give it as [train.motors], on the disc that it drives"
        yield fault("drive", "motor", found="one beside [train.mechanisms]", expected="none", remedy=remedy)
    for name in keys(listed):
        if look(look(look(listed, name), "machine"), "train") is not None:
            remedy = "leave [train] out there, or write its discs into this train"
            expected = "a machine file with a [mechanism], without [train]"
            yield fault(
                "train",
                "mechanisms",
                name,
                "machine",
                found="[train] in it",
                expected=expected,
                remedy=remedy,
            )
