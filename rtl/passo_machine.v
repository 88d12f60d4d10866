// SPDX-License-Identifier: MIT
// Shared by the inputs of all channels: the tick of the filter, e-stop, watchdog, and their registers.
//
// Promise: `read_data` is the addressed register one clock after `bus_read`, for one clock, else 0. `tick` comes every `filter` + 1 clocks, the first time that long after a write of the filter.
`resetall
`timescale 1ns / 1ps
`default_nettype none

module passo_machine (
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
  output reg         tick,
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

  // Filter: it describes the machine and is kept over a reset.
  reg  [15:0] count;
  wire        ends = count == filter;

  always @(posedge clk) begin
    tick  <= ends & ~write_filter;
    count <= count + 16'd1;
    if (ends || write_filter || rst) count <= 16'd0;
    if (write_filter && !rst) filter <= bus_data[15:0];
    if (rst) tick <= 1'b0;
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

  passo_watchdog u_watchdog (
    .clk           (clk),
    .rst           (rst),
    .write         (write_watchdog),
    .bus_data      (bus_data),
    .feed          (bus_write | bus_read),
    .moving        (moving),
    .stop          (watchdog_stop),
    .disable_drives(disable_drives)
  );

endmodule
`resetall
