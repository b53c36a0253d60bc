"""Actions of tori, how their frequencies turn with the actions, and Birkhoff's normal form."""
