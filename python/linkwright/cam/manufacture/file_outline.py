"""An outline as a file holds it."""

from __future__ import annotations

from typing import NamedTuple

from linkwright.cam.manufacture.deviation import Path


class FileOutline(NamedTuple):
    """An outline of a file.

    Attributes
    ----------
    path : Path
        To be compared with the curve.
    form : str
        How the file holds it, such as ``LWPOLYLINE``.
    """

    path: Path
    form: str
