"""Commands about drives.

| module | |
| --- | --- |
| `transient` | ``linkwright transient FILE``: motion in time |
"""
