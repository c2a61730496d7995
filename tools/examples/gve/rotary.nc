(A thread on a cylinder along X, which A turns: three turns in 24 mm; then four marks around it)
G21 G90
G0 X5 Z1
G1 Z-0.5 F200
G93
G1 X29 A1080 F3             (in a third of a minute, whatever A does)
G94
G0 Z1
X35 A1080
G1 Z-0.5 F200
Z1
A1170 F2000                 (A alone: degrees a minute)
Z-0.5 F200
Z1
A1260 F2000
Z-0.5 F200
Z1
A1350 F2000
Z-0.5 F200
G0 Z1
M30
