// SPDX-License-Identifier: MIT
// In place of the watchdog, for the proof of what all channels of a machine share: what comes in goes out again.
`default_nettype none

module passo_watchdog #(
  parameter UNIT_LOG2 = 9
) (
  input  wire        clk,
  input  wire        rst,
  input  wire        tick,
  input  wire        write,
  input  wire [19:0] bus_data,
  input  wire        feed,
  input  wire        moving,
  output wire        stop,
  output wire        disable_drives
);
  assign stop           = ^{write, bus_data};
  assign disable_drives = ^{tick, feed, moving};
endmodule
