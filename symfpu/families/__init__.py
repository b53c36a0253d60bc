"""Families of tori and breathers in energy, with their events."""
