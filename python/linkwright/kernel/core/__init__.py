"""What crosses the border to the compiled core.

| module | |
| --- | --- |
| `core_format` | Whether the compiled core speaks the language of this package |
| `curve` | A curve through points, as the core takes it |
| `periodic_table` | A function that repeats with an angle, as the core takes it |
"""
