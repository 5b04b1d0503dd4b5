"""What a person gets to see of a run: a table, pictures, and files that are written whole."""
