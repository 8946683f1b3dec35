"""``linkwright topper``.

| module | |
| --- | --- |
| `best` | `linkwright topper best FILE`: the best knife of a topper within its limits |
| `field` | `linkwright topper field FILE`: a topper over a field of roots |
"""
