"""Calls of the public face with odd types and sizes: no raw error, no hang, no NaN without a word."""
