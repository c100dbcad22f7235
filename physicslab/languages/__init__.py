"""Words for people in their language: a catalogue of gettext for each, as ``de.po``."""
