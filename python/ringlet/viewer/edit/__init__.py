"""Edits by hand: brushes, drawing, single locks, operators and colors."""
