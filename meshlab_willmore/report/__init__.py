"""The demo's table of stages, and its pictures."""
