(Finds the top of the workpiece with the plate of the tool sensor, which is 15 mm thick)
G21 G91
G38.2 Z-10 F120             (down until it touches; the axes go back to that place)
G92 Z15                     (here Z is 15)
G0 Z5                       (off the plate)
M0 (take the plate away)
G90
G0 Z2
X20
G1 Z-0.5 F200
X40 F600
G0 Z5
M30
