"""ezdxf as it is installed: it would take settings from an ``ezdxf.ini`` in the folder of a machine file."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from linkwright.kernel.system import away_from

if TYPE_CHECKING:
    from ezdxf.document import Drawing


def read_document(path: Any) -> Drawing:
    """Read a DXF file; any error of ezdxf for one that is damaged."""
    with away_from("ezdxf.ini"):
        from ezdxf.filemanagement import readfile
    return readfile(path)


def new_document(version: str, units: int) -> Drawing:
    """An empty drawing; `version`, `units`: as of ezdxf."""
    with away_from("ezdxf.ini"):
        from ezdxf.filemanagement import new
    return new(version, units=units)
