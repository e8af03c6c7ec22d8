"""Grooms as they are shown: made, measured, compared, lit and rendered."""
