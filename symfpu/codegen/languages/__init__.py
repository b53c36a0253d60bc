"""One language a file: source text from a program as data."""
