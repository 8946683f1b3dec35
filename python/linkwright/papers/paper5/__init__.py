"""Paper 5: the knife of a root-crop topper.

| module | |
| --- | --- |
| `conclusions` | what its numbers say; its figures; its page |
| `figures` | what its numbers say; its figures; its page |
| `head` | its head; from (4) to (5); how much its lengths fall short |
| `page` | what its numbers say; its figures; its page |
| `paper` | paper 5 computed anew: the length of a topper's knife |
| `rows` | every formula with its verdict; where its result holds, as tables |
| `short` | its head; from (4) to (5); how much its lengths fall short |
| `step` | its head; from (4) to (5); how much its lengths fall short |
| `surface` | its figure 3; for which angles and heads its result holds |
| `table` | every formula with its verdict; where its result holds, as tables |
| `verdict` | its figure 3; for which angles and heads its result holds |
"""
