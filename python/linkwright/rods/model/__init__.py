"""A string of sucker rods with its pump in a machine file.

| module | |
| --- | --- |
| `measured_card` | A measured surface card, by a file of points or by lists |
| `pump` | The pump at the lower end of the string, and what it lifts |
| `rod_section` | A section: rods of one size and grade |
| `rod_sizes` | Sizes and grades of sucker rods |
| `rod_string` | The string: sections, fluid, damping |
| `string_faults` | What is wrong between a rod string and the machine that moves it |
"""
