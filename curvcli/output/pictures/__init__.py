"""Pictures, histograms and colours."""
