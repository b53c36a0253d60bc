"""The Poincare-Lindstedt series."""
