"""Paper 2: a cart moved by a cam with a combined motion law.

| module | |
| --- | --- |
| `alternatives` | other laws and the crank drive; these as a table |
| `checks` | its closed forms, a second way; these against the general synthesis |
| `conclusions` | what its numbers say; its figures; its page |
| `course` | the cart in steady motion |
| `figures` | what its numbers say; its figures; its page |
| `formulas` | its closed forms, a second way; these against the general synthesis |
| `page` | what its numbers say; its figures; its page |
| `pair` | rollers on the printed profile; two cams that turn in opposite directions |
| `paper` | paper 2 computed anew: the cam drive of a cart |
| `roller` | rollers on the printed profile; two cams that turn in opposite directions |
| `rows` | every printed number and formula of paper 2 with its verdict |
| `start` | which start section has the least ∫ jerk² |
| `table` | other laws and the crank drive; these as a table |
"""
