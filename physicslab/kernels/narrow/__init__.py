"""Where near bodies touch."""
