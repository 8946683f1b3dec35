"""Sizing: what a machine needs so that it does what is asked of it, verified by analysing it.

| module | |
| --- | --- |
| `checks` | Does a motor suffice: power, start, heat, overload, run-up? |
| `commands` | ``linkwright size`` and ``linkwright motors`` |
| `flywheel` | What flywheel keeps the speed within a wanted speed fluctuation? |
| `motor` | Which motor of the catalogue is the smallest that will do? |
| `motor_change` | A machine with another motor or flywheel; inertia of a motor's rotor |
| `power` | What power must the motor have? |
| `warnings` | Contacts that are lost with the motor, limits that are not judged |
"""
