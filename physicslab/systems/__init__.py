"""The systems, one file each. Empty on purpose: the window's systems import pygame, the others must not."""
