"""The program that runs in a window."""
