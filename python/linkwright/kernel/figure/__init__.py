"""What all figures share: style, SVG and PNG, captions.

| module | |
| --- | --- |
| `figure_of` | Figures of what stands below what draws it |
| `legends` | Legends that tell of curves that coincide, as wide as their axes |
| `lines` | Figures that are curves over one axis, in panels |
| `plotted` | The curves of a result as a figure |
| `style` | Colours, fonts, axes |
| `svg` | A figure as SVG, alone and in a page, as PNG, and what the cursor reads in it |
"""
