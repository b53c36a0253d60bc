"""The door to tori: one function for every kind of them."""
