"""Ringlet as a solver of cosseratbench, a benchmark of rods by others (the extra ``cosserat``)."""
