"""The report as one page that needs nothing but a browser: tables, histograms and the surface to turn and to ask."""
