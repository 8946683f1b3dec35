"""Formats of cam tables: what a maker permits, how its controller interpolates, what is written."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Literal

from linkwright.axes.export import plain_text, structured_text
from linkwright.axes.export.cam_data import CamData, CamTitle
from linkwright.axes.export.interpolation import Interpolation
from linkwright.kernel.description.base import suggestion
from linkwright.kernel.errors import InputError, show

Numbers = Literal["LREAL", "REAL", "0.0001"]


@dataclass(frozen=True)
class CamFormat:
    """A format of cam tables."""

    name: str  # as it is asked for
    maker: str
    about: str  # what is written
    interpolation: Interpolation
    write: Callable[[CamData, CamTitle], str]
    read: Callable[[str], CamData]  # what the controller has of the text
    usual: int  # points that are taken where nobody asks for a number
    most: int | None = None  # points at most, as the maker permits
    numbers: Numbers = "LREAL"  # type, or step, of the numbers
    apart: float = 0.0  # minimum distance of two points [deg]
    advances: bool = True  # whether the position may advance per cycle
    is_clamped: bool = False  # whether a spline has the slopes of the law at its ends
    is_even: bool = False  # whether points are at equal distances

    @property
    def has_derivatives(self) -> bool:
        """Whether points have velocity and acceleration."""
        return self.interpolation == "quintic"


_CODESYS = "CODESYS"
_BECKHOFF = "Beckhoff"
_SIEMENS = "Siemens"
_SEW = "SEW-Eurodrive"
_SEW_TABLES: tuple[tuple[str, str, Interpolation, int], ...] = (
    ("sew-linear", "linear", "linear", 1024),
    ("sew-cubic", "polynomials of degree 3", "cubic", 1024),
    ("sew-spline", "spline (eSplineMode periodic or natural)", "spline", 64),
)

_ALL = (
    CamFormat(
        "csv",
        "any",
        "comma-separated values with velocity, acceleration and jerk",
        "quintic",
        plain_text.write_csv,
        plain_text.read_csv,
        361,
        is_even=True,
    ),
    CamFormat(
        "codesys",
        _CODESYS,
        "CamBuilder, polynomials up to degree 7",
        "polynomials",
        structured_text.write_cam_builder,
        structured_text.read_cam_builder,
        73,
    ),
    CamFormat(
        "codesys-xyva",
        _CODESYS,
        "MC_CAM_REF, points with velocity and acceleration",
        "quintic",
        structured_text.write_xyva,
        structured_text.read_xyva,
        73,
    ),
    CamFormat(
        "beckhoff",
        _BECKHOFF,
        "TF5050 motion function, motion points",
        "quintic",
        structured_text.write_motion_function,
        structured_text.read_motion_function,
        73,
    ),
    CamFormat(
        "beckhoff-table",
        _BECKHOFF,
        "TF5050 position table",
        "spline",
        structured_text.write_beckhoff_table,
        structured_text.read_beckhoff_table,
        361,
    ),
    CamFormat(
        "siemens",
        _SIEMENS,
        "S7-1500T data block, points with velocity and acceleration",
        "quintic",
        structured_text.write_siemens,
        structured_text.read_siemens,
        51,
        51,
    ),
    CamFormat(
        "siemens-table",
        _SIEMENS,
        "S7-1500T data block, pairs",
        "spline",
        structured_text.write_siemens_table,
        structured_text.read_siemens_table,
        1000,
        1000,
    ),
    CamFormat(
        "tab",
        "ISG, Beckhoff CNC",
        "table of pairs (.tab)",
        "linear",
        plain_text.write_tab,
        plain_text.read_tab,
        361,
        # The first point is the last one too, which has no line of its own.
        361,
        numbers="0.0001",
        apart=0.1,
        advances=False,
    ),
    *(
        CamFormat(
            name,
            _SEW,
            f"MOVI-C curve points, {words}",
            interpolation,
            plain_text.write_pairs,
            plain_text.read_pairs,
            most,
            most,
        )
        for name, words, interpolation, most in _SEW_TABLES
    ),
    CamFormat(
        "rockwell",
        "Rockwell",
        "Logix 5000 array of CAM, cubic",
        "spline",
        structured_text.write_rockwell,
        structured_text.read_rockwell,
        181,
        numbers="REAL",
        is_clamped=True,
    ),
)

FORMATS = {each.name: each for each in _ALL}


def cam_format(name: str) -> CamFormat:
    """A format by its name; an `InputError` for a name that none has."""
    if name not in FORMATS:
        remedy = suggestion(name, FORMATS) or f"there is {', '.join(FORMATS)}"
        raise InputError(f"--to: found {show(name)}, expected the name of a format; {remedy}")
    return FORMATS[name]
