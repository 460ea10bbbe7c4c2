"""Report as one self-contained HTML page: tables, histograms and an interactive 3D view."""
