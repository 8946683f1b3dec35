"""Results of a synthesis as words, and as a table of the catalogue."""

from __future__ import annotations

from typing import Any

import click

# Results that are angles, and plain numbers; other numbers are lengths.
_ANGLES = ("angle", "swing", "start", "end", "direction")
_RATIOS = (
    "ratio",
    "function",
    "relative",
    "straightness",
    "evaluated",
    "starts",
    "found",
    "rate",
    "seed",
    "links",
    "solutions",
    "residual",
)


def words(name: str, value: Any) -> str:
    """A value for people: angles in degrees, lengths in metres."""
    if value is None:
        return "–"
    if isinstance(value, tuple | list):
        return ", ".join(map(str, value)) or "–"
    if isinstance(value, bool):
        return "yes" if value else "no"
    if not isinstance(value, int | float):
        return str(value)
    if any(part in name for part in _RATIOS):
        return f"{value:.6g}"
    if any(part in name for part in _ANGLES):
        from math import degrees

        return f"{degrees(value):.6g}°"
    return f"{value:.6g} m"


def print_catalogue(lines: tuple[Any, ...]) -> None:
    """The straight-line linkages with what their lines are like."""
    from math import degrees

    click.echo(
        f"{'kind':<14} {'exact':<6} {'links':>5} {'deviation':>11} {'crank range':>20} "
        f"{'longest':>9}  rotates"
    )
    for each in lines:
        span = f"{degrees(each.crank_angle_start):.1f}° to {degrees(each.crank_angle_end):.1f}°"
        deviation = "0" if each.exact else f"{each.deviation:.3g} m"
        click.echo(
            f"{each.kind:<14} {words('', each.exact):<6} {each.links:>5} {deviation:>11} {span:>20} "
            f"{each.size:>7.3g} m  {words('', each.turns_fully)}"
        )
