"""Machine files of the pumping units of the catalogue."""

from __future__ import annotations

from linkwright.pumping.model.unit import INCH, POUND_FORCE
from linkwright.pumping.model.unit_catalogue import CatalogueUnit, catalogue_unit, pumping_units

# Comments of the letters, in the order of the file.
_WORDS = {
    "A": "saddle bearing to polished rod",
    "C": "saddle bearing to equalizer bearing",
    "I": "saddle bearing in front of the crankshaft",
    "P": "pitman",
    "H": "saddle bearing above the base",
    "G": "crankshaft above the base",
}


def unit_template(designation: str | None = None, hole: int | None = None) -> str:
    """A machine file of a pumping unit."""
    found = catalogue_unit(designation) if designation is not None else pumping_units()[0]
    number = 1 if hole is None else hole
    stroke = float(found.unit(number).stroke)
    return f"""\
# Beam pumping unit {found.designation}, crank pin in hole {number}.
# Dimensions by the letters of API Spec 11E.
#
# The stroke of the mechanism is {stroke:.4f} m;
# the longest by the designation is {found.rating.stroke:.4f} m.
format = 1
name = "Pumping unit {found.designation}, hole {number}"
source = "Guo, Lyons, Ghalambor, Petroleum Production Engineering, 2007, table 12.1"

[drive]
speed = "8 rpm"                          # strokes per minute

[pumping_unit]
geometry = "conventional"
designation = "{found.designation}"
{_dimensions(found, number)}
structural_unbalance = "{found.structural_unbalance / POUND_FORCE:.6g} lbf"

# Load of the polished rod; replace it by that of your well, or remove it.
[pumping_unit.load]
position = [0, 0.1, 1]                   # 0 at the bottom of the stroke, 1 at the top
up = {_loads(found, 0.45, 0.7, 0.65)}
down = {_loads(found, 0.45, 0.35, 0.3)}
counterbalance = "optimal"               # or the maximum moment of cranks and counterweights: "20 kN m"
"""


def _dimensions(unit: CatalogueUnit, hole: int) -> str:
    """The letters in inches, as the catalogue prints them."""
    values = {name: getattr(unit, name) for name in _WORDS}
    lines = [_line(name, value, _WORDS[name]) for name, value in values.items()]
    others = ", ".join(f"{radius / INCH:.6g}" for radius in unit.holes)
    return "\n".join([*lines, _line("R", unit.holes[hole - 1], f"crank; holes at {others} in")])


def _line(name: str, value: float, words: str) -> str:
    entry = f'{name} = "{value / INCH:.6g} in"'
    return f"{entry:<40} # {words}"


def _loads(unit: CatalogueUnit, *shares: float) -> str:
    """Loads as shares of the rating of the structure."""
    texts = (f'"{share * unit.rating.load / 1e3:.1f} kN"' for share in shares)
    return f"[{', '.join(texts)}]"
