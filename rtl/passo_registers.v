// SPDX-License-Identifier: MIT
// Registers of the core: what it is, RUN, and the status word. The refusal counters have their addresses here, but the
// link keeps them.
//
// Promise: `read_data` is the addressed register one clock after `bus_read`, for one clock, and 0 if it is none of
// these; it is the status word at all other times. RUN changes for all channels on the same clock. `bad_value`, one
// clock late: a word of RUN has a channel that the core lacks.
`resetall
`timescale 1ns / 1ps
`default_nettype none

module passo_registers #(
  parameter        CHANNELS        = 1,
  parameter        AXES            = 4,
  parameter        TICK_LOG2       = 7,
  parameter        LINE_QUEUE_LOG2 = 8,
  parameter        RAMP_QUEUE_LOG2 = 4,
  parameter        INPUTS          = 0,
  parameter        ENCODERS        = 0,
  parameter        OUTPUTS         = 0,
  parameter        RASTER          = 0,
  parameter        COMPARE         = 0,
  parameter        TRACKERS        = 0,
  parameter        TRACKED         = 0,
  parameter [31:0] CLOCK_HZ        = 0,
  parameter [31:0] BUILD           = 0
) (
  input  wire                                    clk,
  input  wire                                    rst,
  // bus
  input  wire                                    bus_write,
  input  wire                                    bus_read,
  input  wire [                            11:0] bus_address,
  input  wire [                            18:0] bus_data,
  output wire                                    bad_value,
  output wire [                            31:0] read_data,
  // link
  input  wire [                             7:0] last_sequence,
  output reg                                     is_counters,    // the address is that of refusal counters
  // channels
  output reg  [                    CHANNELS-1:0] run,
  output reg  [                    CHANNELS-1:0] wait_sync,
  input  wire                                    any_stopped,
  input  wire                                    any_occupied,
  input  wire [CHANNELS*(LINE_QUEUE_LOG2+1)-1:0] line_room,
  input  wire [CHANNELS*(RAMP_QUEUE_LOG2+1)-1:0] ramp_room
);

  `include "passo_registers.vh"

  localparam [31:0] PARAMETERS = {
    OUTPUTS[0],
    ENCODERS[0],
    INPUTS[0],
    RAMP_QUEUE_LOG2[4:0],
    TRACKED[2:0],
    LINE_QUEUE_LOG2[4:0],
    TRACKERS[0],
    COMPARE[0],
    RASTER[0],
    TICK_LOG2[4:0],
    AXES[3:0],
    CHANNELS[3:0]
  };

  reg [2:0] status_channel;

  // Room of one channel, 255 = 255 or more
  wire [LINE_QUEUE_LOG2:0] status_line_room = line_room[status_channel*(LINE_QUEUE_LOG2+1)+:LINE_QUEUE_LOG2+1];
  wire [RAMP_QUEUE_LOG2:0] status_ramp_room = ramp_room[status_channel*(RAMP_QUEUE_LOG2+1)+:RAMP_QUEUE_LOG2+1];
  wire [15:0] wide_line_room = {{(15 - LINE_QUEUE_LOG2) {1'b0}}, status_line_room};
  wire [15:0] wide_ramp_room = {{(15 - RAMP_QUEUE_LOG2) {1'b0}}, status_ramp_room};

  wire [31:0] status;
  assign status[STATUS_MARKER_LSB+:STATUS_MARKER_BITS] = STATUS_MARKER_RESET;
  assign status[STATUS_ANY_STOPPED_LSB] = any_stopped;
  assign status[STATUS_ANY_OCCUPIED_LSB] = any_occupied;
  assign status[STATUS_ZERO_LSB] = STATUS_ZERO_RESET;
  assign status[STATUS_CHANNEL_LSB+:STATUS_CHANNEL_BITS] = status_channel;
  assign status[STATUS_SEQUENCE_LSB+:STATUS_SEQUENCE_BITS] = last_sequence;
  assign status[STATUS_LINE_ROOM_LSB+:STATUS_LINE_ROOM_BITS] = wide_line_room > 16'd255 ? 8'd255 : wide_line_room[7:0];
  assign status[STATUS_RAMP_ROOM_LSB+:STATUS_RAMP_ROOM_BITS] = wide_ramp_room > 16'd255 ? 8'd255 : wide_ramp_room[7:0];

  wire [7:0] run_padded = {{(8 - CHANNELS) {1'b0}}, run};
  wire [7:0] wait_sync_padded = {{(8 - CHANNELS) {1'b0}}, wait_sync};
  reg run_beyond;  // one clock late: the word is stable by then
  wire run_beyond_next = ({1'b0, bus_data[7:0]} >> CHANNELS) != 9'd0 || ({1'b0, bus_data[15:8]} >> CHANNELS) != 9'd0
                         || {1'b0, bus_data[18:16]} >= CHANNELS[3:0];

  wire [2:0] number = bus_address[2:0];

  // Decoded one clock ahead of the strobe: the address is stable by then.
  reg       known;  // one of the first eight
  reg       is_run;
  reg [3:0] reads;  // registers 0 .. 3
  reg       reads_clock;
  reg       reads_build;
  reg       reads_status;

  integer i;

  assign bad_value = is_run & run_beyond;

  assign read_data =
      (reads_status ? status : 32'd0)
      | (reads[0] ? IDENTIFICATION_RESET : 32'd0)
      | (reads[1] ? {8'd0, VERSION_MAJOR_RESET, VERSION_MINOR_RESET, VERSION_PATCH_RESET} : 32'd0)
      | (reads[2] ? PARAMETERS : 32'd0)
      | (reads[3] ? {13'd0, status_channel, wait_sync_padded, run_padded} : 32'd0)
      | (reads_clock ? CLOCK_HZ : 32'd0)
      | (reads_build ? BUILD : 32'd0);

  always @(posedge clk) begin
    known        <= bus_address[11:3] == 9'd0;
    is_counters  <= bus_address[11:1] == ADDRESS_REFUSALS_0[11:1];
    is_run       <= bus_address == ADDRESS_RUN;
    run_beyond   <= run_beyond_next;
    reads_status <= ~bus_read;
    for (i = 0; i < 4; i = i + 1) reads[i] <= bus_read && known && number == i[2:0];
    reads_clock <= bus_read && known && number == ADDRESS_CLOCK[2:0];
    reads_build <= bus_read && known && number == ADDRESS_BUILD[2:0];
    if (bus_write && is_run) begin
      run            <= bus_data[CHANNELS-1:0];
      wait_sync      <= bus_data[8+:CHANNELS];
      status_channel <= bus_data[18:16];
    end
    if (rst) begin
      run            <= RUN_RUN_RESET[CHANNELS-1:0];
      wait_sync      <= RUN_WAIT_SYNC_RESET[CHANNELS-1:0];
      status_channel <= RUN_STATUS_CHANNEL_RESET;
    end
  end

`ifdef FORMAL
  `include "passo_registers_formal.vh"
`endif

endmodule
`resetall
