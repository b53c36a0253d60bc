"""Evaluators as source code: one program, one emitter a language."""
