"""The chain: its modes and couplings, and what they alone decide."""
