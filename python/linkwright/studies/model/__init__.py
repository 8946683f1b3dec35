"""What a study file holds.

| module | |
| --- | --- |
| `study` | Variables, responses, constraints, goals, and how rows are drawn |
"""
