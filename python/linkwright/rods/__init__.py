"""Strings of sucker rods below a pumping unit: prediction, and diagnosis of dynamometer cards.

| module | |
| --- | --- |
| `along` | The string between its stations, and cards of the stations |
| `analyses` | Its analyses, as study, report, studio and studies read it |
| `card` | A measured surface card, and what shows that it is none of this well |
| `check` | What can be seen without solving, and what a machine consists of |
| `commands` | ``linkwright rods``: prediction, and diagnosis of a card |
| `core` | The core's string of sucker rods |
| `diagnosis` | Diagnosis of a measured surface card |
| `field_day` | Cards of a field day: their files, and what is shown and written of them |
| `figures` | Figures of rod strings: cards, torque of the gearbox, Goodman diagram, loads by depth |
| `gradient` | Derivatives of a predicted rod string by entries |
| `many` | Many predictions at once |
| `many_cards` | Measured cards of a field day at once |
| `model/` | A rod string with its pump in a machine file |
| `motion_gradient` | The string in motion with derivatives, at constant speed or with its motor |
| `numbers` | Terms of API RP 11L |
| `plunger_load` | What a pump card tells: plunger stroke, fluid load, fillage |
| `polished_rod` | Motion of the polished rod in time, with the drive that moves it |
| `prediction` | Predicted motion of a rod string |
| `scalars` | Loads, strokes, powers: formulas for numbers, rows and derivatives |
| `scene` | A rod string under its polished rod, as the moving drawing shows it |
| `spectrum` | Harmonics of a measured card that stand above its noise |
| `stress` | Loads and stresses of the sections, by the modified Goodman diagram |
| `tables` | Results of rod strings as tables of text |
| `warnings` | What a rod string cannot bear, and what its user should know besides |
"""

from linkwright import exports

__getattr__ = exports(globals())
