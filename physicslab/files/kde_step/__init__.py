"""Worlds of KDE Step as scenes: its XML, its items, and what they are here."""
