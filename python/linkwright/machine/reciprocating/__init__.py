"""Parts of a reciprocating engine, and what follows from them in closed form."""
