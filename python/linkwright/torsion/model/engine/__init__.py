"""Reciprocating engines: descriptions of their parts, and what follows from them in closed form."""
