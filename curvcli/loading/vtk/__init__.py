"""VTK data sets, XML and legacy: cells, arrays and attributes, shared by the formats that hold them."""
