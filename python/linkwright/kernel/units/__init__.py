"""Units stop here: a number or a text with a unit comes in, an SI float comes out.

| module | |
| --- | --- |
| `kinds` | Physical quantities: word, SI unit, dimension, range |
| `spellings` | Units as people write them |
| `reading` | Numbers and texts as quantities, and back |
| `marks` | Marks of a description's fields |
"""
