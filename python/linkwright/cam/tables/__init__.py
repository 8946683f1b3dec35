"""Tables of cams.

| module | |
| --- | --- |
| `cam` | A cam as tables of text |
| `laws` | Tables of motion laws: their factors, and the bounds from below |
"""
