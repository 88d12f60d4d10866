// SPDX-License-Identifier: MIT
// Shared by the inputs of all channels: the tick of the filter, e-stop, watchdog, and their registers.
//
// Promise: `read_data` is the addressed register one clock after `bus_read`, for one clock, else 0. `tick` comes every `filter` + 1 clocks, the first time that long after a write of the filter.
`resetall
`timescale 1ns / 1ps
`default_nettype none

module passo_machine #(
  parameter TICK_LOG2 = 7  // clocks of a slew tick
) (
  input  wire        clk,
  input  wire        rst,
  // bus
  input  wire        bus_write,
  input  wire        bus_read,
  input  wire [11:0] bus_address,
  input  wire [19:0] bus_data,
  output wire [31:0] read_data,
  // pin
  input  wire        estop_n,
  // channels
  input  wire        moving,         // a motion runs
  input  wire        slew_tick,      // every 2^TICK_LOG2 clocks
  output wire        tick,
  output reg  [15:0] filter,
  output wire        write_filter,   // strobe: `filter` changes with the next clock
  output wire        pressed,        // asynchronous: take all enables away
  output wire        estop,          // hard stop
  output wire        watchdog_stop,
  output wire        disable_drives
);

  `include "passo_registers.vh"

  // Decoded one clock ahead of the strobe: the address is stable by then.
  reg        known;
  wire [1:0] number = bus_address[1:0];
  reg        read_estop;
  wire       write = bus_write & known;
  wire       write_watchdog = write && number == ADDRESS_WATCHDOG[1:0];
  wire       write_clear = write && number == ADDRESS_ESTOP_CLEAR[1:0] && bus_data[0];

  assign write_filter = write && number == ADDRESS_INPUT_FILTER[1:0];

  assign read_data = {31'd0, estop & read_estop};

  always @(posedge clk) begin
    known      <= bus_address[11:2] == ADDRESS_INPUT_FILTER[11:2];
    read_estop <= bus_read && known && number == ADDRESS_ESTOP[1:0];
  end

  // Filter: it describes the machine and is kept over a reset. The count goes down to 0, and what enables it selects
  // what it takes, so that each bit is one LUT.
  reg  [15:0] count;
  reg         begins;  // a period, of a new filter
  wire        runs = count != 16'd0 && !begins;

  assign tick = count == 16'd0 && !begins;

  always @(posedge clk) begin
    count  <= runs ? count + {16{runs}} : filter;
    begins <= write_filter | rst;
    if (write_filter && !rst) filter <= bus_data[15:0];
  end

  initial filter = INPUT_FILTER_FILTER_RESET;

  passo_estop u_estop (
    .clk    (clk),
    .rst    (rst),
    .estop_n(estop_n),
    .clear  (write_clear),
    .pressed(pressed),
    .stop   (estop)
  );

  passo_watchdog #(
    .UNIT_LOG2(16 - TICK_LOG2)
  ) u_watchdog (
    .clk           (clk),
    .rst           (rst),
    .tick          (slew_tick),
    .write         (write_watchdog),
    .bus_data      (bus_data),
    .feed          (bus_write | bus_read),
    .moving        (moving),
    .stop          (watchdog_stop),
    .disable_drives(disable_drives)
  );

`ifdef FORMAL
  `include "passo_machine_formal.vh"
`endif

endmodule
`resetall
