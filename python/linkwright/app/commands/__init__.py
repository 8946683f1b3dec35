"""Commands that are of no single subject.

| module | |
| --- | --- |
| `check` | `linkwright check FILE`: is the machine file sound, and the geometry that it describes? |
| `draw` | `linkwright draw FILE`: a mechanism to scale, still or in motion |
| `glossary` | `linkwright glossary [WORD]`: the terms of tables, messages and reports |
| `mcp` | `linkwright mcp`: checks, results and meanings for assistants |
| `new` | `linkwright new TEMPLATE`: a machine file to start from |
| `papers` | `linkwright papers`: published numbers against computed ones |
| `plot` | `linkwright plot FILE QUANTITY…`: curves of a machine as picture and table |
| `report` | `linkwright report COMMAND …`: the answer of a command as a page or PDF |
| `run` | `linkwright run FILE`: everything that can be computed about a machine |
| `schema` | `linkwright schema`: the JSON Schema of machine files, for editors |
"""
