"""Exact statements, their certificates, and the independent checker."""
