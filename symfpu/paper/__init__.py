"""The paper: its printed numbers, its figures, a verdict on every claim."""
