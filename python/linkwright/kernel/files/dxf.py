"""ezdxf as it is installed: it would take settings from an ``ezdxf.ini`` in the folder of a machine file."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import TYPE_CHECKING, Any, TypeVar

from linkwright.kernel.errors import LinkwrightError, MachineFileError, Problem, UnitError
from linkwright.kernel.files.text_file import TextError, data_of
from linkwright.kernel.limits import POINT_BYTES
from linkwright.kernel.system import away_from
from linkwright.kernel.units.kinds import LENGTH
from linkwright.kernel.units.reading import parse

if TYPE_CHECKING:
    from ezdxf.document import Drawing

Read = TypeVar("Read")

# Units of $INSUNITS that drawings are in [m]; DXF Reference, header variables.
_UNITS = {1: 0.0254, 2: 0.3048, 4: 1e-3, 5: 1e-2, 6: 1.0, 13: 1e-6, 14: 1e-1}


def read_document(path: Any) -> Drawing:
    """Read a DXF file; any error of ezdxf for one that is damaged."""
    with away_from("ezdxf.ini"):
        from ezdxf.filemanagement import readfile
    return readfile(path)


class DrawingError(Exception):
    """What is wrong with what is drawn: found, expected, remedy."""

    def __init__(self, found: str, expected: str, remedy: str = "") -> None:
        super().__init__(found)
        self.found, self.expected, self.remedy = found, expected, remedy


def read_drawing(path: Path, key: str, read: Callable[[Drawing], Read]) -> Read:
    """What `read` makes of a DXF file that the entry at `key` names.

    Raises MachineFileError: the file cannot be read, or `read` raises any error.
    """
    try:
        data_of(path, POINT_BYTES)
    except TextError as error:
        raise wrong_drawing(path, key, error.found, error.expected or "a DXF file", error.remedy) from None
    try:
        return read(read_document(path))
    except DrawingError as error:
        raise wrong_drawing(path, key, error.found, error.expected, error.remedy) from None
    except LinkwrightError:
        raise
    except Exception as error:
        # ezdxf raises any error for a damaged file.
        words = " ".join(str(error).split()) or type(error).__name__
        found = f"a file that cannot be read as DXF ({words})"
        raise wrong_drawing(path, key, found, "a DXF file") from None


def unit_of(document: Drawing, unit: Any, key: str) -> float:
    """Length of a unit of a drawing [m]: the one that is given beside the file at `key`, or its own.

    Raises DrawingError: there is neither; MachineFileError: the given one is no length.
    """
    if unit is not None:
        try:
            return parse(unit, LENGTH)
        except UnitError as error:
            found, expected = error.problem.found, 'the length of a unit of the drawing, such as "1 mm"'
            beside = key.removesuffix("file") + "unit"
            raise MachineFileError([Problem(beside, found, expected, error.problem.remedy)]) from None
    known = _UNITS.get(int(document.header.get("$INSUNITS", 0)))
    if known is None:
        found = "a drawing that does not say its unit ($INSUNITS)"
        raise DrawingError(found, 'an entry unit = "1 mm" beside it')
    return known


def wrong_drawing(path: Path, key: str, found: str, expected: str, remedy: str = "") -> MachineFileError:
    """What is wrong with a DXF file that the entry at `key` names."""
    return MachineFileError([Problem(key, found, expected, remedy, str(path))])


def new_document(version: str, units: int) -> Drawing:
    """An empty drawing; `version`, `units`: as of ezdxf."""
    with away_from("ezdxf.ini"):
        from ezdxf.filemanagement import new
    return new(version, units=units)
