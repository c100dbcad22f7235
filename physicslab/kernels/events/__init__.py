"""Impacts located in time."""
