"""What a reader wants: units and digits, the zero of crank angles, a language.

| module | |
| --- | --- |
| `angle_marks` | Marks of crank angles along x |
| `angle_zero` | Crank angles as they are shown, from the file's zero or a dead centre |
| `axes` | Axes of figures in the units, from the dead centre and with the words that the reader wants |
| `language` | Reports in another language: texts by a catalogue, numbers and units as it writes them |
| `numbers` | Numbers as text, and cells that know their number |
| `out_units` | Units in which numbers are shown |
| `sentences` | Findings and warnings in the units, and with the crank angles, of the reader |
"""
