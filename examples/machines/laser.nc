%
(A rounded square; the power follows the speed)
G21 G90 G17
M4 S0
G0 X0.2
G1 X1 F6000 S600
G3 X1.2 Y0.2 J0.2
G1 Y1
G3 X1 Y1.2 I-0.2
G1 X0.2
G3 X0 Y1 J-0.2
G1 Y0.2 S300
G3 X0.2 Y0 I0.2
M5
G0 X0
M30
%
