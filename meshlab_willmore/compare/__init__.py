"""Energies, searches and MeshLab's own flips side by side on one mesh."""
