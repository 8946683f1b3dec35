"""What all pages share: numbers as text, tables, formulas, templates.

| module | |
| --- | --- |
| `csv` | Curves as text |
| `formulas` | Formulas of the measures, with their sources |
| `glossary` | The field's words: terms, definitions, sources, and the words that they replace |
| `html` | What the pages of all reports share: templates by Jinja2, figures and data inside the page |
| `measured` | Cells of tables that know their number |
| `notebook` | Results and machines as a notebook shows them |
| `numbers` | Numbers and angles as text |
| `out_units` | Units in which numbers are shown |
| `table` | A table of text, and the rows that attributes of results make |
"""
