"""Controls by mouse and keys."""
