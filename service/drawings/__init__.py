"""Drawings of a linkage at true scale: one description in millimetres, written as DXF and as SVG."""
