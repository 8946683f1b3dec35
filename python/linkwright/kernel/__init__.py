"""What all subjects stand on: errors, units, descriptions, numerics, results, files, pages.

| module | |
| --- | --- |
| `arrays` | NumPy's arrays by what they hold |
| `check` | One check against a limit |
| `command/` | What the commands share: options, errors as messages, the terminal, progress, output folders |
| `core/` | What crosses the border to the compiled core |
| `description/` | What all descriptions share: faults in the words of the file, addresses, formulas, curves |
| `errors` | What can go wrong, in two families: the input is wrong, or the machine cannot do it |
| `extras` | Packages that only some functions need, and the command that installs them |
| `figure/` | What all figures share: style, SVG and PNG, captions |
| `files/` | Files in and out: text, tables, points, whole files or none, the library, templates |
| `findings` | What a study has to say |
| `later` | Functions that are named by their place, and imported when they are called |
| `limits` | How much of everything there may be |
| `numerics/` | Numerics that no library has as it is needed here |
| `page/` | What all pages share: tables, formulas, templates |
| `public/` | What public functions have in common |
| `quantities` | Words, symbols and units of results, declared at their attributes |
| `reader/` | What a reader wants: units and digits, the zero of crank angles, a language |
| `result` | Scalars, curves and tables of a result |
| `system` | What Windows does in another way than Unix |
| `units/` | Units stop here: a number or a text with a unit comes in, an SI float comes out |
"""
