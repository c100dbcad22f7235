"""Scenes and other files on disk."""
