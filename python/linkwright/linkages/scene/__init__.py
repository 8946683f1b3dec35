"""What the moving sketch draws.

| module | |
| --- | --- |
| `gears` | Gears, pulleys and racks in the moving sketch |
| `parts` | What the moving sketch draws: one part for each element of the machine, from behind to the front |
"""
