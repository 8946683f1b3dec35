"""Tables of toppers, and what reports say of them.

| module | |
| --- | --- |
| `field` | Tables of a field, a sweep and the best knife |
| `topper` | Results of toppers as tables of text |
| `words` | What a report says of a topper beside its numbers: headline, formulas, assumptions |
"""
