"""Files of labels for `--regions`: numpy arrays, text and CSV, FreeSurfer's .annot, .label and curv, GIFTI."""
