"""What is drawn on, and from where it is seen."""
