"""What all pages share: numbers as text, tables, formulas, templates.

| module | |
| --- | --- |
| `content` | What a report says, before it is a page or a PDF |
| `csv` | Curves as text |
| `formulas` | Formulas of the measures, with their sources |
| `glossary` | The field's words: terms, definitions, sources, and the words that they replace |
| `html` | A report as a page, by templates of Jinja2; figures and data are in it |
| `measured` | Cells of tables that know their number |
| `notebook` | Results and machines as a notebook shows them |
| `numbers` | Numbers and angles as text |
| `out_units` | Units in which numbers are shown |
| `table` | A table of text, and the rows that attributes of results make |
| `typeset` | A report as PDF, by Typst |
"""
