"""The canvas and the camera."""
