"""Theorems about computed solutions: breathers that exist and their stability, residuals of tori,
how long orbits stay near them.
"""
