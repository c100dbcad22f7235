"""Outlines of bodies: vertices and a radius, and everything that follows from them alone."""
