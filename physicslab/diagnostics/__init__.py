"""Figures and warnings about a world."""
