"""Sizing: what a machine needs so that it does what is asked of it, verified by analysing it.

| module | |
| --- | --- |
| `checks` | Does a motor suffice: power, start, heat, overload, run-up? |
| `commands/` | `linkwright size FILE`: the smallest motor and flywheel that will do |
| `fit` | The machine with a motor or a flywheel put in |
| `flywheel` | What flywheel keeps the speed within a wanted speed fluctuation? |
| `inertia` | What inertia has a rotor of which the catalogue says nothing? |
| `motor` | Which motor of the catalogue is the smallest that will do? |
| `power` | What power must the motor have? |
"""
