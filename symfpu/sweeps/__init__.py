"""Sweeps: any function over many cases, each of them a row, on processes that may die."""
