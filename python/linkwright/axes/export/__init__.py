"""Laws as cam tables of motion controllers: written, read back, interpolated, compared.

| module | |
| --- | --- |
| `cam_data` | What a cam table holds: points with derivatives, or polynomials |
| `command` | `linkwright law` |
| `exported` | The export of a law: its text, and the deviations measured in it |
| `formats` | The formats of makers: limits, numbers, interpolation |
| `interpolation` | What a controller makes of a table |
| `placement` | Where the points of a table stand |
| `plain_text` | CSV, `.tab` and pairs of numbers |
| `structured_text` | Structured Text of CODESYS, Beckhoff, Siemens and Rockwell |
| `tables` | Formats compared, as a table |
"""
