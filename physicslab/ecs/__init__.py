"""Entities and components as rows of columns."""
