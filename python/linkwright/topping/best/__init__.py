"""The best knife of a topper within its limits.

| module | |
| --- | --- |
| `best_knife` | What knife of a topper is the shortest, or the fastest, that keeps its limits? |
| `knife_search` | The search for the best knife of a topper |
| `knife_trial` | Trials of knives on one field, and the limit that fails |
"""
