"""What crosses the border to the compiled core.

| module | |
| --- | --- |
| `curve` | A curve through points, as the core takes it |
| `periodic_table` | A function that repeats with an angle, as the core takes it |
"""
