"""Results as text, tables and records."""
