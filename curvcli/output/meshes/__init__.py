"""Writers of coloured meshes, one file per format."""
