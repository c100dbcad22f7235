"""Random scenes whose outcome is known in another way, to judge estimates of errors by."""
