"""The published values of a paper, from its file of data."""

from __future__ import annotations

import tomllib
from dataclasses import dataclass
from functools import cache
from importlib.resources import files
from typing import Any

from linkwright.kernel.errors import InputError

# Columns of the table of results of paper 1, in its order: name → (symbol, unit).
QUANTITIES = {
    "turns": ("turns", ""),
    "speed_min": ("ω_min", "rad/s"),
    "speed_max": ("ω_max", "rad/s"),
    "speed_mean": ("ω_mean", "rad/s"),
    "acceleration_min": ("ε_min", "rad/s²"),
    "acceleration_max": ("ε_max", "rad/s²"),
    "unevenness": ("δ", ""),
    "dynamism": ("H", ""),
    "motion_coefficient": ("k_p", ""),
}

PAPERS = {
    1: "Unevenness of motion of the drives of roller-forming machines, one to four carts",
    2: "Cam drive of a roller-forming machine with a combined mode of motion",
    3: "Torsional vibration of V-type engines, and the unevenness of their rotation",
    4: "Lever mechanism of a worm-type rotator of a sucker-rod string",
    5: "Movement of a topper knife over the head of a root, and the length of its edge",
}


@dataclass(frozen=True)
class PublishedDrive:
    """One row of the table of results.

    Attributes
    ----------
    name, source : str
        What it is; where it is printed.
    machine : str
        Its file in the library.
    carts : int
        How many.
    motor_printed : bool
        Whether the paper prints its motor.
    values : dict of str to float
        Quantity → printed value in SI.
    """

    name: str
    source: str
    machine: str
    carts: int
    motor_printed: bool
    values: dict[str, float]


@dataclass(frozen=True)
class Published:
    """All that is published in a paper and used here.

    Attributes
    ----------
    number : int
        Of the paper.
    title, original : str
        In English, and as printed.
    drives : tuple of PublishedDrive
        The table of results.
    intermediates : tuple of dict
        Values printed on the way: name, quantity, value, unit, note.
    cases : tuple of dict
        What a recomputation must give, with tolerances and their reasons.
    """

    number: int
    title: str
    original: str
    drives: tuple[PublishedDrive, ...]
    intermediates: tuple[dict[str, Any], ...]
    cases: tuple[dict[str, Any], ...]


def known_paper(number: int) -> int:
    """The number of a paper, if it is one of `PAPERS`.

    Parameters
    ----------
    number : int
        The number.

    Returns
    -------
    int
        The same.

    Raises
    ------
    InputError
        There is no such paper.
    """
    if number not in PAPERS:
        raise InputError(f"no paper {number}; there is {', '.join(map(str, PAPERS))}")
    return number


@cache
def printed_values(number: int) -> dict[str, Any]:
    """The printed values of a paper, as its file of data has them.

    Parameters
    ----------
    number : int
        Of the paper.

    Returns
    -------
    dict
        In SI.

    Raises
    ------
    InputError
        There is no such paper.
    """
    n = known_paper(number)
    return tomllib.loads(
        files(f"linkwright.papers.paper{n}").joinpath(f"paper{n}.toml").read_text(encoding="utf-8")
    )


def published(number: int) -> Published:
    """Read the published table of a paper that has one.

    Parameters
    ----------
    number : int
        1.

    Returns
    -------
    Published
        Values in SI.

    Raises
    ------
    InputError
        There is no such paper.
    """
    data = printed_values(number)
    return Published(
        number=data["number"],
        title=data["title"],
        original=data["original"],
        drives=tuple(_drive(row) for row in data["drive"]),
        intermediates=tuple(data["intermediate"]),
        cases=tuple(data["case"]),
    )


def _drive(row: dict[str, Any]) -> PublishedDrive:
    given = row["given"]
    return PublishedDrive(
        name=row["name"],
        source=row["source"],
        machine=given["machine"],
        carts=given["carts"],
        motor_printed=given["motor_printed"],
        values=row["expect"],
    )
