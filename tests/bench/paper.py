"""The paper's figures, of tables 1 to 6 of its supplement: its Living Room at 1920x1080 with 128 samples."""
# Tables 1 to 3: overhead in percent of the first and the second render of Rousselle and others, and of the paper's method.
OVERHEAD = {"Floor": (3.00, 30.97, 14.07), "Wall": (3.46, 28.16, 11.46), "Floor+Wall": (4.39, 30.96, 21.16)}
# Tables 4 and 5: megabytes of one object, of two.
MEGABYTES = {"control-biased": (47.55, 46.3), "control-unbiased": (97.5, 94.6), "aovs": (66.2, 116), "jpeg": (23.59, 52.6)}
# Table 6: seconds from a set to a picture of a size.
SECONDS = {"640x640": 0.719, "1080x1080": 1.373, "2048x2048": 3.603, "4096x3840": 10.88}
