"""Cam tables as Structured Text: CODESYS, Beckhoff, Siemens and Rockwell; written, and read back.

Sources: CODESYS, *SM3_CamBuilder* and *SM3_Basic*, library documentation; Beckhoff, *TF5050 TwinCAT 3 NC
Camming*; Siemens, *LCamHdl*, library documentation; Rockwell Automation, *Motion Instructions*,
MOTION-RM002.
"""

from __future__ import annotations

import re
from collections.abc import Iterable, Sequence

import numpy as np

from linkwright.axes.export.cam_data import CamData, CamTitle
from linkwright.kernel.arrays import Floats
from linkwright.kernel.files.cam_tables import structured_rows, without_comments


def real(number: float | np.float32) -> str:
    """A number as a literal of IEC 61131-3 that reads back exactly, such as ``1.5E-7``."""
    # That a single-precision number is shown by fewer digits is a matter of its type.
    text = str(number if isinstance(number, np.float32) else float(number) + 0.0)
    mantissa, mark, power = text.partition("e")
    return f"{mantissa if '.' in mantissa else f'{mantissa}.0'}{f'E{int(power)}' if mark else ''}"


def identifier(name: str) -> str:
    """A name as an identifier of IEC 61131-3."""
    word = re.sub("_+", "_", re.sub(r"[^A-Za-z0-9]", "_", name)).strip("_")
    return f"cam_{word}" if not word[:1].isalpha() else word


def plain(text: str) -> str:
    """A text for a comment, on one line, that does not end it."""
    return re.sub(r"\s+", " ", text.replace("*", "").replace("//", "/")).strip()


def _head(title: CamTitle, *more: str) -> list[str]:
    """Comments at the head of a text."""
    advance = f"; it advances by {title.advance:.12g} {title.unit} per cycle" if title.advance else ""
    about = f"{title.machine}: law of {title.name}; master in deg, position in {title.unit}{advance}"
    return [f"(* {plain(line)} *)" for line in (about, *more)]


def _text(lines: Iterable[str]) -> str:
    return "\n".join(lines) + "\n"


def _structures(rows: Iterable[Sequence[tuple[str, str]]]) -> list[str]:
    """Structures of an array, one on each line."""
    made = [f"    ({', '.join(f'{name} := {value}' for name, value in row)})" for row in rows]
    return [*(f"{line}," for line in made[:-1]), f"{made[-1]}];"]


def _columns(text: str, *names: str) -> list[Floats]:
    """Columns of the structures or assignments that have all of some fields."""
    rows = structured_rows(text, *names)
    return [np.array([float(row.entries[name]) for row in rows]) for name in names]


# -- CODESYS ---------------------------------------------------------------------------------------------


def write_cam_builder(data: CamData, title: CamTitle) -> str:
    """A program that builds the cam of polynomials; their x counts from the start of each."""
    name, n = identifier(title.name), len(data.powers)
    lines = [
        *_head(title, "CODESYS SoftMotion 4.17 or later, library SM3_CamBuilder"),
        f"PROGRAM Build_{name}",
        "VAR",
        "    camBuilder : SMCB.CamBuilder;",
        "    camRef : MC_CAM_REF;",
        f"    segments : ARRAY[1..{n}] OF SMC_CAM_SEGMENT;",
        "END_VAR",
        "camBuilder.Init();",
    ]
    for low, high, powers in zip(data.x[:-1], data.x[1:], data.powers, strict=True):
        degree = 5 if len(powers) <= 6 else 7
        values = [low, high, *powers, *[0.0] * (degree + 1 - len(powers))]
        lines.append(f"camBuilder.Append(SMCB.Poly{degree}_Coeffs({', '.join(map(real, values))}));")
    lines += [
        "(* then SMCB.InitCamRef for camRef with segments, and camBuilder.Write *)",
        "END_PROGRAM",
    ]
    return _text(lines)


_POLYNOMIAL = re.compile(r"SMCB\.Poly[57]_Coeffs\(([^()]*+)\)")


def read_cam_builder(text: str) -> CamData:
    """The polynomials of such a program."""
    found = _POLYNOMIAL.finditer(without_comments(text))
    rows = [[float(value) for value in polynomial[1].split(",")] for polynomial in found]
    x = np.array([row[0] for row in rows] + [rows[-1][1]])
    powers = tuple(tuple(row[2:]) for row in rows)
    end = sum(c * (rows[-1][1] - rows[-1][0]) ** k for k, c in enumerate(powers[-1]))
    return CamData(x, np.array([*(row[0] for row in powers), end]), powers=powers)


def write_xyva(data: CamData, title: CamTitle) -> str:
    """An array of points with velocity and acceleration, and the cam that refers to it."""
    assert data.v is not None
    assert data.a is not None
    name, n = identifier(title.name), len(data.x)
    columns = zip(data.x, data.y, data.v, data.a, strict=True)
    rows = [list(zip(("dX", "dY", "dV", "dA"), map(real, row), strict=True)) for row in columns]
    cam = (
        f"nElements := {n}, byType := 3, byVarType := 6, xStart := {real(data.x[0])}, "
        f"xEnd := {real(data.x[-1])}, nTappets := 0, strCAMName := '{name}', pce := ADR({name}_A)"
    )
    return _text(
        [
            *_head(title, "CODESYS SoftMotion, cam of type XYVA"),
            "VAR_GLOBAL",
            f"{name}_A : ARRAY[0..{n - 1}] OF SMC_CAMXYVA := [",
            *_structures(rows),
            f"{name} : MC_CAM_REF := ({cam});",
            "END_VAR",
        ]
    )


def read_xyva(text: str) -> CamData:
    """The points of such an array."""
    x, y, v, a = _columns(text, "dX", "dY", "dV", "dA")
    return CamData(x, y, v, a)


# -- Beckhoff --------------------------------------------------------------------------------------------


def write_motion_function(data: CamData, title: CamTitle) -> str:
    """An array of points of a motion function, each a motion point, joined by polynomials of degree 5."""
    assert data.v is not None
    assert data.a is not None
    name, n = identifier(title.name), len(data.x)
    rows = [
        [
            ("PointIndex", str(i)),
            ("FunctionType", "MOTIONFUNCTYPE_POLYNOM5_MM"),
            ("PointType", "MOTIONPOINTTYPE_MOTION"),
            ("RelIndexNextPoint", "1"),
            ("MasterPos", real(x)),
            ("SlavePos", real(y)),
            ("SlaveVelo", real(v)),
            ("SlaveAcc", real(a)),
            ("SlaveJerk", "0.0"),
        ]
        for i, (x, y, v, a) in enumerate(zip(data.x, data.y, data.v, data.a, strict=True), start=1)
    ]
    return _text(
        [
            *_head(title, "Beckhoff TF5050, motion function; derivatives are by the master position"),
            "VAR_GLOBAL",
            f"{name}_points : ARRAY[1..{n}] OF MC_MotionFunctionPoint := [",
            *_structures(rows),
            *_beckhoff_cam(name, "points", "MC_TABLETYPE_MOTIONFUNCTION", n, 1),
        ]
    )


def _beckhoff_cam(name: str, array: str, kind: str, rows: int, columns: int) -> list[str]:
    """The structure that refers to an array, of which a program sets the address."""
    return [
        f"{name} : MC_CAM_REF := (TableType := {kind}, NoOfRows := {rows}, NoOfColumns := {columns});",
        "END_VAR",
        f"(* in a program: {name}.pArray := ADR({name}_{array});",
        f"   {name}.ArraySize := SIZEOF({name}_{array}); *)",
    ]


def read_motion_function(text: str) -> CamData:
    """The points of a motion function."""
    x, y, v, a = _columns(text, "MasterPos", "SlavePos", "SlaveVelo", "SlaveAcc")
    return CamData(x, y, v, a)


def write_beckhoff_table(data: CamData, title: CamTitle) -> str:
    """A table of master and slave positions."""
    name, n = identifier(title.name), len(data.x)
    rows = [f"    {real(x)}, {real(y)}" for x, y in zip(data.x, data.y, strict=True)]
    return _text(
        [
            *_head(title, "Beckhoff TF5050, position table; couple with MC_INTERPOLATIONTYPE_SPLINE"),
            "VAR_GLOBAL",
            f"{name}_table : ARRAY[0..{n - 1},0..1] OF LREAL := [",
            *(f"{row}," for row in rows[:-1]),
            f"{rows[-1]}];",
            *_beckhoff_cam(name, "table", "MC_TABLETYPE_NONEQUIDISTANT", n, 2),
        ]
    )


_TABLE = re.compile(r"\bOF\s++LREAL\s*+:=\s*+\[([^\]]*+)\]")


def read_beckhoff_table(text: str) -> CamData:
    """The positions of such a table."""
    found = _TABLE.search(without_comments(text))
    values = np.array([float(value) for value in found[1].split(",")] if found else []).reshape(-1, 2)
    return CamData(values[:, 0], values[:, 1])


# -- Siemens ---------------------------------------------------------------------------------------------


def _data_block(title: CamTitle, about: str, kind: str, rows: Sequence[Sequence[tuple[str, str]]]) -> str:
    """A data block with an array of structures."""
    assigned = (
        f"    profile[{i}].{name} := {value};" for i, row in enumerate(rows, start=1) for name, value in row
    )
    return _text(
        [
            *(f"//{line[2:-3]}" for line in _head(title, about)),
            f'DATA_BLOCK "{identifier(title.name)}"',
            "{ S7_Optimized_Access := 'TRUE' }",
            "VERSION : 0.1",
            "NON_RETAIN",
            "VAR",
            f"    profile : Array[1..{len(rows)}] of {kind};",
            "END_VAR",
            "BEGIN",
            *assigned,
            "END_DATA_BLOCK",
        ]
    )


_BASIC = ("leadingValue", "followingValue", "velocityRatio", "accelerationRatio")


def write_siemens(data: CamData, title: CamTitle) -> str:
    """A data block of points with velocity and acceleration."""
    assert data.v is not None
    assert data.a is not None
    columns = zip(data.x, data.y, data.v, data.a, strict=True)
    rows = [list(zip(_BASIC, map(real, row), strict=True)) for row in columns]
    about = "SIMATIC S7-1500T, LCamHdl_CreateCamBasic: polynomials of degree 5 between the points"
    return _data_block(title, about, '"LCamHdl_typeBasicPoint"', rows)


def read_siemens(text: str) -> CamData:
    """The points of such a data block."""
    x, y, v, a = _columns(text, *_BASIC)
    return CamData(x, y, v, a)


def write_siemens_table(data: CamData, title: CamTitle) -> str:
    """A data block of pairs."""
    rows = [[("x", real(x)), ("y", real(y))] for x, y in zip(data.x, data.y, strict=True)]
    about = "SIMATIC S7-1500T, LCamHdl_CreateCamBasedOnXYPoints; interpolate the cam by cubic splines"
    return _data_block(title, about, '"TO_Cam_Struct_PointData"', rows)


def read_siemens_table(text: str) -> CamData:
    """The pairs of such a data block."""
    x, y = _columns(text, "x", "y")
    return CamData(x, y)


# -- Rockwell --------------------------------------------------------------------------------------------


def write_rockwell(data: CamData, title: CamTitle) -> str:
    """Assignments to an array of CAM elements, and the call that makes a profile of it."""
    assert data.slopes is not None
    name, n = identifier(title.name), len(data.x)
    start, end = (real(np.float32(slope)) for slope in data.slopes)
    lines = [
        *_head(title, f"Logix 5000, {name} : CAM[{n}], {name}_profile : CAM_PROFILE[{n}]; numbers are REAL")
    ]
    for i, (x, y) in enumerate(zip(data.x.astype(np.float32), data.y.astype(np.float32), strict=True)):
        lines += [
            f"{name}[{i}].Master := {real(x)};",
            f"{name}[{i}].Slave := {real(y)};",
            f"{name}[{i}].SegmentType := 1;",
        ]
    lines.append(f"MCCP({name}_control, {name}[0], {n}, {start}, {end}, {name}_profile[0]);")
    return _text(lines)


_SLOPES = re.compile(r"\bMCCP\([^,]++,[^,]++,[^,]++,([^,]++),([^,]++),")


def read_rockwell(text: str) -> CamData:
    """The array, with the slopes of the call."""
    x, y = _columns(text, "Master", "Slave")
    found = _SLOPES.search(text)
    return CamData(x, y, slopes=(float(found[1]), float(found[2])) if found else None)
