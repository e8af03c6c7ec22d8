"""Motion: simulation, its frames and their playback."""
