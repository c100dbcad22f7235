"""What the user does with mouse and keys."""
