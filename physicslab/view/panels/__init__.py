"""Figures and text beside the world."""
