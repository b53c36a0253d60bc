"""Independent checkers of certificates: the standard library alone, no code of any prover.

A folder for each theorem. `python -I -S symfpu/checkers FILE` checks a certificate of any kind
without anything that is installed.
"""
