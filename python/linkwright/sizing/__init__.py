"""Sizing: what a machine needs so that it does what is asked of it, verified by analysing it again.

| module | answers |
| --- | --- |
| `power` | what power must the motor have? |
| `motor` | which motor of the catalogue is the smallest that will do? |
| `checks` | does a motor suffice: power, start, heat, overload, run-up? |
| `inertia` | what inertia has a rotor of which the catalogue says nothing? |
| `flywheel` | what flywheel keeps the speed within a wanted unevenness? |
| `topper` | what knife of a topper is the shortest, or the fastest, that keeps its limits? |
| `knife_search`, `knife_trial` | where it is sought, and what each knife does |
| `knife_failing` | which limit does no knife keep, and by how much? |
| `fit` | the machine with a motor or a flywheel put in |
"""
