"""Reports: the model (the JSON) and its other forms."""
