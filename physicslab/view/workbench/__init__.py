"""The panels around the world, and the window's layout."""
