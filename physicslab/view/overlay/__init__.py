"""What is drawn over the world to explain it."""
