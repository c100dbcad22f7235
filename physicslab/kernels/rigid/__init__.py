"""Rigid contacts: constrained motion between located events."""
