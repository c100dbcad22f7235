"""The systems of a frame: input, picture, figures. They are given what they read from and draw with."""
