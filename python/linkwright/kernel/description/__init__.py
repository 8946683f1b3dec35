"""What all descriptions share: faults in the words of the file, addresses, formulas, curves.

| module | |
| --- | --- |
| `base` | What all descriptions share |
| `curve` | Curves given by points |
| `cycle` | Cycles of several revolutions: the angle after which a torque or a load repeats |
| `deferred_model` | Tables of a machine file that another room describes |
| `formula` | Formulas as texts |
| `formula_faults` | What can be wrong with a formula in a file: its text, its names, its constants |
| `place` | Places in a description: addresses as text, and what stands there, checked or raw |
| `problems` | Errors of pydantic, in the words of the file |
| `schema_walk` | What belongs at an address, read from the annotations of the models |
| `shown_units` | Units in which tables, figures and CSV of a machine show its numbers |
"""
