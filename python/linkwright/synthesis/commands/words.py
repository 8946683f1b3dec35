"""Results of a synthesis as words, as a table of the catalogue, and as JSON."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import typer


def print_json(found: dict[str, Any], warnings: Sequence[str] = ()) -> None:
    """One object on standard output."""
    from json import dumps

    told = {"findings": [], "warnings": list(warnings)}
    typer.echo(dumps(found | told, allow_nan=False, ensure_ascii=False))


def plain(value: Any) -> Any:
    """A value that JSON can hold: None for what is not finite."""
    if isinstance(value, dict):
        return {key: plain(each) for key, each in value.items()}
    if isinstance(value, list):
        return [plain(each) for each in value]
    is_number = isinstance(value, float) and not isinstance(value, bool)
    return None if is_number and not abs(value) < float("inf") else value


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


def print_catalogue(lines: tuple[Any, ...], json: bool) -> None:
    """The straight-line linkages with what their lines are like."""
    if json:
        rows = [plain(each.to_dict()) for each in lines]
        print_json({"machine": "", "results": {"straight_lines": rows}})
        return
    typer.echo(
        f"{'kind':<14} {'exact':<6} {'links':>5} {'deviation':>11} {'crank range':>20} {'longest':>9}  turns"
    )
    for each in lines:
        from math import degrees

        span = f"{degrees(each.crank_angle_start):.1f}° to {degrees(each.crank_angle_end):.1f}°"
        deviation = "0" if each.exact else f"{each.deviation:.3g} m"
        typer.echo(
            f"{each.kind:<14} {words('', each.exact):<6} {each.links:>5} {deviation:>11} {span:>20} "
            f"{each.size:>7.3g} m  {words('', each.turns_fully)}"
        )
