"""LaTeX tables, for papers."""
