"""The potentials of a bond: one file a kind."""
