"""What a mesh is: checked arrays, half-edge connectivity, and the flip."""
