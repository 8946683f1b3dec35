"""Tables of toppers, and what reports say of them.

| module | |
| --- | --- |
| `best` | The best knife of a topper: table, warnings, lines of a machine file, map as CSV |
| `field` | Tables of a topper over a field of roots, and its curves as CSV |
| `topper` | Results of toppers as tables of text |
| `words` | What a report says of a topper beside its numbers: headline, formulas, assumptions |
"""
