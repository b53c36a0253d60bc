"""One language a file: what its templates need of a program."""
