"""Figures of a world, and warnings about it."""
