"""USD, one concept a file."""
