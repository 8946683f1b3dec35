"""Functional mock-up units: a drive with its mechanism for other simulation tools (FMI 2.0 and 3.0).

| module | |
| --- | --- |
| `fmu` | a machine as an FMU |
| `program` | its numbers and structure, rigid or elastic |
| `variables` | what the importing tool sets and reads |
| `parameters` | entries of the machine that stay adjustable |
| `units` | units by exponents, and those for display |
| `description` | `modelDescription.xml` of both versions |
| `core` | the machine as data, which the library reads |
| `library` | the compiled library, one for each platform |
| `archive` | the zip of all |
| `tables` | the same for people |
| `commands` | `linkwright fmu` |
"""
