"""The fingerprint: some hundred numbers and the record of every result, from every function that gives one.

`make fingerprint` computes them anew and compares them with values.json; `make fingerprint UPDATE=1` writes what has changed, for
which reasons.json must name a reason. The cases are functions in the modules that CASES lists.
"""
