"""The studio: a machine in the browser, moving, with every entry at hand and every answer beside it.

No mechanics is computed here: the studio asks the rooms of the subjects, and the page draws what it is sent.

    page ──► guards ──► session ──► document ──► machine ──► analyses ──► shown, drawing ──► wire ──► page

| module | |
| --- | --- |
| `command` | ``linkwright studio [FILE]`` |
| `server` | The page, its modules, a socket for each tab |
| `wire` | Messages: a number, words, arrays |
| `messages` | What a page may ask: the shape of every request |
| `session` | One tab: the newest machine at once, slow analyses beside, files |
| `worker` | The process of slow analyses |
| `analyses` | What can be computed, and which data are missing |
| `shown` | Results for the page, from declared quantities |
| `drawing` | The drawing with rates, forces and handles |
| `views` | Pictures beside it: trains in their modes, the knife of a topper; what the gallery shows |
| `timing` | The timing diagram of cams and axes, with the entries that move ends of sections |
| `drag` | Which lengths bring a point to a place, and where the linkage no longer closes |
| `building` | Elements that are added, links that are drawn |
| `design` | What entries do to a result, and which entries bring it to a value |
| `search` | Sweeps and optimisations of the machine, in the process beside |
| `export` | Reports, motions and poses as files |
| `controls` | Controls of all entries, from the descriptions |
| `document` | The text of the file: changes that keep comments |
| `files` | Files below the folder, library, templates |
| `language` | Texts of the page and messages of the server in another language |
| `widget` | The drawing in a notebook; `notebook/` is its part of the page |
| `static/` | The page: plain modules, styles, vendored libraries |
"""
