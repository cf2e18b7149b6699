"""The method "minimax": sequential convex programming of one objective that is the greatest of pieces."""

from ..convex.minimax import search as minimax

__all__ = ["minimax"]
