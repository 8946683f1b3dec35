"""What all pages share: quantities in words, tables, formulas, templates.

| module | |
| --- | --- |
| `csv` | Curves as text |
| `formulas` | Formulas of the measures, with their sources |
| `html` | What the pages of all reports share: templates by Jinja2, figures and data inside the page |
| `quantities` | Words, symbols and units of results; numbers as text |
| `table` | A table of text, and the rows that attributes of results make |
"""
