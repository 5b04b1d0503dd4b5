"""Mesh files: their names and formats, loading and saving them, and what is lost in that."""
