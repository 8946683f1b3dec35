"""Studies of many machines: which entries vary, what is asked of them, and what follows.

| module | |
| --- | --- |
| `model` | The study file |
| `read` | A study and its machine from files |
| `write` | Write a study as a file, beside a machine file |
| `plan` | A study checked against its machine, ready to run |
| `distributions` | Distributions: the value below which a share lies |
| `axes` | Variables: the value of each share between 0 and 1 |
| `choices` | Names of the values of a list |
| `sampling` | Rows as shares: grid, Sobol, Latin hypercube, random |
| `study_response` | One response: where it comes from, and one number out of a result |
| `point_responses` | Responses that follow from places of points: motions, errors of paths |
| `responses` | What is asked: analyses, and one number of each result |
| `rows` | Rows of a study: numbers, why rows fail, what becomes of fast starts |
| `engine` | Responses of many machines, in batches or one by one |
| `parquet` | Rows as Parquet files |
| `folder` | The folder of a sweep |
| `sweep` | A sweep, and its continuation |
| `sizes` | Studies that size drive, cam or damper for the minimum cost |
| `cams` | Studies of cams: sizes, lift and laws within limits |
| `knives` | Studies of the knife of a topper over a field of roots |
| `best_knives` | The best knife of a topper as a study |
| `paths` | Path generation as a study |
| `point_slopes` | Derivatives of responses that follow from places of points |
| `slopes` | Derivatives of responses by variables, exact where the analysis has them |
| `tolerance` | Scatter of responses, contributions, yield |
| `worst_case` | The machine at the corners of the tolerances |
| `indices` | Sobol indices with their confidence intervals |
| `allocation` | The cheapest tolerances for a wanted yield |
| `least_cost` | Factors of minimum cost within limits of squares |
| `front` | Machines of which none is better in both of two goals |
| `workers` | Files of a sweep by processes beside, or by a cluster |
| `optimise` | The best machine, what it touches and what wider limits would be worth |
| `search` | The search for it, by CMA-ES over batches and by derivatives |
| `chosen` | The machine that shares of the variables describe |
| `search_log` | The log of a search, which goes on by replaying it |
| `local` | Down to the nearest best machine by exact derivatives |
| `limits` | Limits that a machine touches, and what they cost |
| `fit` | Numbers of a machine from a measured record |
| `fit_search` | Where that search begins, and how noise is weighed |
| `record` | A measured record |
| `fit_parameters` | The numbers that a record is fitted by |
| `predicted` | What a machine would have recorded, and its derivatives |
| `identifiability` | What a record tells of numbers |
| `tables`, `figures` | What is shown |
| `commands/` | ``linkwright sweep``, ``tolerance``, ``optimise``, ``fit`` |
"""

from linkwright import exports

__getattr__ = exports(globals())
