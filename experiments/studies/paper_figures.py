"""What the paper reports: Steder, Grisetti, Van Loock, Burgard, "Robust On-line Model-based Object Detection from Range Images"."""

CLASSES = ('box', 'fan', 'monitor', 'office_chair', 'pioneer', 'table', 'wooden_chair')

# Table I: rows are what was detected, columns what stands there, the last one clutter. 20 scans, every class ten times.
TABLE1 = {
    'box':          (8, 0, 3, 0, 0, 0, 0, 4),
    'fan':          (0, 7, 0, 0, 0, 0, 0, 0),
    'monitor':      (2, 2, 10, 1, 0, 0, 1, 4),
    'office_chair': (0, 1, 0, 8, 0, 0, 2, 0),
    'pioneer':      (0, 0, 0, 0, 10, 0, 0, 3),
    'table':        (0, 0, 0, 0, 0, 7, 0, 1),
    'wooden_chair': (0, 2, 0, 3, 0, 0, 9, 0),
}
TABLE1_RECALL, TABLE1_PRECISION, TABLE1_ZETA = 0.84, 0.67, 23.2  # 59 of 70, 59 of 88, 59^2 / (11^2 + 29)

# Figure 7 (its curve is not in the text): without occlusion, below 5 m and beyond 12 m.
FIGURE7_NEAR = (5.0, 0.89)  # m, recognition rate
FIGURE7_LIMIT = 12.0        # m
TILT_LIMIT = 15.0           # degrees of roll or pitch that are tolerated (section III-A)

# Figure 5: best settings of the two descriptors (section IV): cells a side, support in metres.
FIGURE5_BEST = {'range_patch': (8, 0.35), 'spherical_spin': (5, 0.60)}

# Run times of section V, ms, on a dual core of 2.4 GHz: (stage, least, most)
RUN_TIMES = (
    ('range image', 100, 120), ('interest points', 150, 250), ('descriptors', 300, 500), ('matching', 250, 450),
    ('candidate search', 100, 300), ('scoring', 15, 150), ('collisions', 1, 100), ('rejection of false positives', 500, 1400),
)
RUN_TIME_WHOLE = (1500, 3000)  # ms a scan
