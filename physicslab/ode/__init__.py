"""Smooth motion as ordinary differential equations."""
