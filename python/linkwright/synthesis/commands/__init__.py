"""``linkwright synthesise``.

| module | |
| --- | --- |
| `synthesise` | `linkwright synthesise …`: from what a linkage shall do to a machine file |
| `words` | Results of a synthesis as words, and as a table of the catalogue |
"""
