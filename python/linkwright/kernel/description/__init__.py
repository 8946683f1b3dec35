"""What all descriptions share: faults in the words of the file, addresses, formulas, curves.

| module | |
| --- | --- |
| `base` | What all descriptions share; reading checked and raw ones alike |
| `curve` | Curves given by points |
| `elsewhere` | Tables of a machine file that another room describes |
| `formula` | Formulas as texts |
| `formula_faults` | What can be wrong with a formula in a file: its text, its names, its constants |
| `plain` | What all descriptions share; reading checked and raw ones alike |
| `problems` | What belongs where; errors in the words of the file |
| `schema_walk` | What belongs where; errors in the words of the file |
| `text` | Entries by address |
"""
