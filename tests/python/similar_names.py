"""Pairs of different names that become alike where names are made valid, or on disks that ignore case."""

SIMILAR = [
    ("a.1", "a_1"),
    ("Bo.1", "Bo_1"),
    ("hair", "Hair"),
    ("straße", "STRASSE"),
    ("\u82b1", "\u8349"),  # one character each, of Chinese
    ("e\u0301l\u00e8ve", "\u00e9l\u00e8ve"),  # composed, and not
    ("", "_"),
    ("1a", "_1a"),
    ("a b", "a\tb"),
    ("x" * 300, "x" * 301),
    ("a/b", "a:b"),
    ("a.", "a"),
    ("NUL", "_NUL"),
    ("\U0001f600", "\U0001f601"),
]
