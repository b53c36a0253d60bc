"""Theorems about computed solutions: breathers that exist, their stability, residuals of tori, how long orbits stay near them."""
