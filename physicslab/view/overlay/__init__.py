"""Overlays that explain the world."""
