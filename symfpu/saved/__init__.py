"""Every result as a file, and back."""
