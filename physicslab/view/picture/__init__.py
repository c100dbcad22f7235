"""The world as a picture."""
