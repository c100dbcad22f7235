"""The systems of a frame: input, picture, figures. They import pygame."""
