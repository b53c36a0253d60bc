"""Pictures of results: axes in, axes out."""
