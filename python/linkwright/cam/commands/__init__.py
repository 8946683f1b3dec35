"""``linkwright cam``.

| module | |
| --- | --- |
| `file` | `linkwright cam FILE`: a machine's cams, and the files to make them by |
| `laws` | `linkwright cam …`: a machine's cams; the motion laws of cams, compared |
| `search` | `linkwright cam search`: many variants of a cam, and the smallest that keep their limits |
"""
