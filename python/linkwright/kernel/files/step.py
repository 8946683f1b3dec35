"""STEP files by the Open CASCADE kernel, an extra: its modules, its arrays, a solid on a plane, its file.

Source: ISO 10303-214; Open CASCADE Technology, *STEP Translator*.
"""

from __future__ import annotations

from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

from linkwright.kernel.errors import ExchangeError
from linkwright.kernel.extras import require


def kernel(module: str) -> Any:
    """A module of Open CASCADE; the error says how to install it."""
    need = "STEP files need the Open CASCADE kernel"
    part, message = (require(f"OCP.{name}", "step", need) for name in (module, "Message"))
    # It would print what it does, into the output of whoever called.
    printers = message.Message_PrinterOStream.get_type_descriptor_s()
    message.Message.DefaultMessenger_s().RemovePrinters(printers)
    return part


def filled(kind: Any, values: list[Any]) -> Any:
    """An array of Open CASCADE, whose indices begin at 1."""
    array = kind(1, len(values))
    for i, value in enumerate(values, start=1):
        array.SetValue(i, value)
    return array


def wire_of(file: Path, edges: list[Any]) -> Any:
    """A closed wire of edges in order. Raises ExchangeError: it does not close."""
    wire = kernel("BRepBuilderAPI").BRepBuilderAPI_MakeWire()
    for edge in edges:
        wire.Add(edge)
    if not wire.IsDone() or not wire.Wire().Closed():
        raise ExchangeError(f"{file}: Open CASCADE does not close the outline")
    return wire.Wire()


def prism(file: Path, outer: Any, width: float, holes: list[Any] | None = None) -> Any:
    """The solid above a wire on z = 0, without holes. `width` [m]. Raises ExchangeError: it is not sound."""
    made = kernel("BRepBuilderAPI").BRepBuilderAPI_MakeFace(outer, True)
    for hole in holes or []:
        made.Add(hole)
    along = kernel("gp").gp_Vec(0, 0, 1e3 * width)
    solid = kernel("BRepPrimAPI").BRepPrimAPI_MakePrism(made.Face(), along).Shape()
    if not kernel("BRepCheck").BRepCheck_Analyzer(solid).IsValid():
        raise ExchangeError(f"{file}: Open CASCADE does not make a sound solid of the outline")
    return solid


def solid_bytes(name: str, solid: Any) -> bytes:
    """A solid in millimetres as the content of a file. Raises ExchangeError: it cannot be written."""
    with TemporaryDirectory() as folder:
        file = Path(folder) / "solid.step"
        write_solid(file, name, solid)
        return file.read_bytes()


def write_solid(file: Path, name: str, solid: Any) -> None:
    """Write a solid in millimetres. Raises ExchangeError: the file cannot be written."""
    control, static = kernel("STEPControl"), kernel("Interface").Interface_Static
    writer = control.STEPControl_Writer()
    static.SetCVal_s("write.step.schema", "AP214IS")
    static.SetCVal_s("write.step.unit", "MM")
    static.SetCVal_s("write.step.product.name", name)
    writer.Transfer(solid, control.STEPControl_StepModelType.STEPControl_ManifoldSolidBrep)
    if writer.Write(str(file)) != kernel("IFSelect").IFSelect_ReturnStatus.IFSelect_RetDone:
        raise ExchangeError(f"{file}: Open CASCADE does not write the file")
