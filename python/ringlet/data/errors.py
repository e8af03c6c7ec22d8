"""The one exception for everything a user can cause."""


class UserError(Exception):
    """A mistake in the input, in one line: what, where, which value, and what to do about it.

    The command line prints it and exits with 2; it never shows a traceback.
    Example: ``UserError("curls.recipe.toml: curl.width is -0.2 m; must be at least 0")``.
    """
