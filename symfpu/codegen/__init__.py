"""Evaluators as source code: one program, two templates a language."""
