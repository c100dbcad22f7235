"""Accuracy, stability and speed, measured."""
