"""What all pages share: tables, formulas, templates.

| module | |
| --- | --- |
| `angle_zero` | Crank angles as they are shown, from the file's zero or a dead centre |
| `checks` | Checks against limits as a table |
| `content` | What a report says, before it is a page or a PDF |
| `formulas` | Formulas of the measures, with their sources |
| `glossary` | The field's words: terms, definitions, sources, and the words that they replace |
| `html` | A report as a page, by templates of Jinja2; figures and data are in it |
| `notebook` | Results and machines as a notebook shows them |
| `table` | A table of text, the rows that attributes of results make, and tables and curves as CSV |
| `translation` | A content in a language, its figures too |
| `typeset` | A report as PDF, by Typst |
"""
