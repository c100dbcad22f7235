"""Eight contacts side by side."""
