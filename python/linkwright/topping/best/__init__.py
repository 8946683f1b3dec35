"""The best knife of a topper within its limits.

| module | |
| --- | --- |
| `best_knife` | What knife of a topper is the shortest, or the fastest, that keeps its limits? |
| `limit_failure` | Which limit does no knife keep, and by how much? |
| `knife_search` | The search for the best knife of a topper |
| `knife_trial` | One knife of a topper that may be the best |
"""
