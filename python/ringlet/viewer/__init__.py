"""The review: a page in the browser for grooming and playback, and its server."""
