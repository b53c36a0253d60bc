"""Numbers: what was typed, and the arithmetics that carry it."""
