"""Theorems about computed tori: how well they solve the equations of motion, and for how long."""
