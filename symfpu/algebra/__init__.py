"""Polynomials in the seed amplitudes: grading, rings and compiled products. Knows nothing of
physics.
"""
