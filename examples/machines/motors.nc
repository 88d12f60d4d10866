%
(Each motor by itself, then all at once)
G21 G90
G1 X20 F6000
Y-15
Z4 F900
A360 F21600
G0 X0 Y0 Z0 A0
G4 P0.1
G93 G1 X10 Y10 Z2 A180 F120 (in half a second)
X0 Y0 Z0 A0 F60
M30
%
