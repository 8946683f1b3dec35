"""Addresses as text: ``bodies."cart1.rod".mass``. A part with a point in it stands in quotes."""

from __future__ import annotations

import re
from collections.abc import Iterable

from linkwright.kernel.errors import InputError

_PART = re.compile(r"""\s*(?:"([^"]*)"|'([^']*)'|([^."'\s][^."']*?))\s*(\.|$)""")
# What TOML calls a bare key; every other key needs quotes.
_BARE = re.compile(r"[A-Za-z0-9_-]+")


def split(address: str) -> tuple[str, ...]:
    """The parts of an address.

    Parameters
    ----------
    address : str
        Such as ``mechanism.cranks.A2.phase``.

    Returns
    -------
    tuple of str
        Its parts, without quotes.

    Raises
    ------
    InputError
        The text is no address.

    Examples
    --------
    >>> split('bodies."cart1.rod".mass')
    ('bodies', 'cart1.rod', 'mass')
    """
    parts, position, more = [], 0, True
    while more:
        match = _PART.match(address, position)
        if match is None:
            raise InputError(f'"{address}" is not an address: expected keys with points between them')
        parts.append(match[1] or match[2] or match[3] or "")
        position, more = match.end(), match[4] == "."
    return tuple(parts)


def join(parts: Iterable[str]) -> str:
    """The address of some parts; the inverse of `split`.

    Parameters
    ----------
    parts : iterable of str
        Keys from the top down.

    Returns
    -------
    str
        With quotes where a key needs them.
    """
    return ".".join(part if _BARE.fullmatch(part) else _quoted(part) for part in parts)


def _quoted(part: str) -> str:
    """A part in quotes; no name has both kinds, and a key that has is quoted with one."""
    if '"' in part and "'" in part:
        part = part.replace('"', "'")
    return f"'{part}'" if '"' in part else f'"{part}"'
