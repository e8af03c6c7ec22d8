"""The public functions: what the command line does, for programs.

They follow the data: recipe → groom → cache → hairs → pictures. ``progress``, wherever it is taken, is called as
``progress(stage, done, total)``.

A module is loaded when ``ringlet`` is first asked for one of its names, which ``ringlet/__init__.pyi`` lists.
"""
