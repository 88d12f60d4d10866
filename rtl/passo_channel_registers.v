// SPDX-License-Identifier: MIT
// Registers of one channel: commands, time scale, drain velocity, state; and which of the channel's blocks an
// address means.
//
// Promise: the answer to a strobe comes one clock later, for one clock; it is 0 unless one of these registers
// is meant. A command strobe is high for the clock after its write.
`resetall
`default_nettype none

module passo_channel_registers #(
  parameter AXES            = 4,
  parameter LINE_QUEUE_LOG2 = 8,
  parameter RAMP_QUEUE_LOG2 = 4
) (
  input  wire                     clk,
  input  wire                     rst,
  // bus
  input  wire                     bus_check,
  input  wire                     bus_write,
  input  wire                     bus_read,
  input  wire                     bus_push,
  input  wire                     select,
  input  wire [              7:0] bus_address,        // within the channel
  input  wire [             31:0] bus_data,
  output reg                      claim,
  output reg  [              3:0] refusal,
  output reg  [             31:0] read_data,
  // blocks
  output reg                      select_line_queue,  // a push to it
  output reg                      select_ramp_queue,
  output reg  [         AXES-1:0] select_axis,
  output reg  [         AXES-1:0] select_position,
  // settings
  output reg  [             16:0] rate_target,
  output reg  [             16:0] rate_slew,
  output reg  [             16:0] stop_slew,
  output reg  [             31:0] drain_velocity,
  // commands
  output reg                      command_stop,
  output reg                      command_abort,
  output reg                      command_clear,
  output reg                      command_zero,
  // state
  input  wire                     occupied,
  input  wire [              2:0] state,
  input  wire [              2:0] cause,
  input  wire                     stopping,
  input  wire [         AXES-1:0] overrun,
  input  wire [             15:0] drained,
  input  wire [             16:0] rate,
  input  wire [             31:0] velocity,           // upper 32 bits
  input  wire [LINE_QUEUE_LOG2:0] line_room,
  input  wire [RAMP_QUEUE_LOG2:0] ramp_room
);

  `include "passo_registers.vh"

  localparam [16:0] RATE_ONE = 17'h10000;
  localparam [31:0] VELOCITY_MAX = 32'h8000_0000;

  wire       is_line = bus_address == CHANNEL_LINE;
  wire       is_ramp = bus_address == CHANNEL_RAMP;
  wire [7:0] overrun_padded = {{(8 - AXES) {1'b0}}, overrun};

  // Known a clock before the strobe, because the address is.
  genvar axis;
  generate
    for (axis = 0; axis < AXES; axis = axis + 1) begin : g_axis
      localparam [2:0] NUMBER = axis;
      always @(posedge clk) begin
        select_axis[axis]     <= select && bus_address[7:3] == {CHANNEL_AXIS_BASE[7:6], NUMBER};
        select_position[axis] <= select && bus_address == CHANNEL_POSITION_BASE + {5'd0, NUMBER};
      end
    end
  endgenerate
  always @(posedge clk) begin
    select_line_queue <= select & bus_push & is_line;
    select_ramp_queue <= select & bus_push & is_ramp;
  end

  // What a check or a read of this address is answered
  reg        known;
  reg [ 3:0] check_refusal;
  reg [ 3:0] read_refusal;
  reg [31:0] value;

  always @* begin
    known         = 1'b1;
    check_refusal = VERDICT_OK;
    read_refusal  = VERDICT_BAD_OPERATION;
    value         = 32'd0;
    case (bus_address)
      CHANNEL_COMMAND: begin
        if ((bus_data & ~CHANNEL_COMMAND_DEFINED) != 32'd0) check_refusal = VERDICT_BAD_VALUE;
        else if (occupied && (bus_data[CHANNEL_COMMAND_CLEAR_LSB] || bus_data[CHANNEL_COMMAND_ZERO_LSB]))
          check_refusal = VERDICT_BUSY;
      end
      CHANNEL_RATE_TARGET, CHANNEL_RATE_SLEW, CHANNEL_STOP_SLEW:
      if (bus_data > {15'd0, RATE_ONE}) check_refusal = VERDICT_BAD_VALUE;
      CHANNEL_DRAIN_VELOCITY: if (bus_data > VELOCITY_MAX) check_refusal = VERDICT_BAD_VALUE;
      CHANNEL_STATE: begin
        check_refusal = VERDICT_READ_ONLY;
        read_refusal  = VERDICT_OK;
        value         = {drained, overrun_padded, stopping, cause, 1'b0, state};
      end
      CHANNEL_RATE: begin
        check_refusal = VERDICT_READ_ONLY;
        read_refusal  = VERDICT_OK;
        value         = {15'd0, rate};
      end
      CHANNEL_ROOM: begin
        check_refusal = VERDICT_READ_ONLY;
        read_refusal = VERDICT_OK;
        value = {{(15 - LINE_QUEUE_LOG2) {1'b0}}, line_room, {(15 - RAMP_QUEUE_LOG2) {1'b0}}, ramp_room};
      end
      CHANNEL_VELOCITY: begin
        check_refusal = VERDICT_READ_ONLY;
        read_refusal  = VERDICT_OK;
        value         = velocity;
      end
      CHANNEL_LINE, CHANNEL_RAMP: check_refusal = bus_push ? VERDICT_OK : VERDICT_BAD_OPERATION;
      default: known = 1'b0;
    endcase
    if (bus_push && !is_line && !is_ramp) check_refusal = VERDICT_BAD_OPERATION;
  end

  always @(posedge clk) begin
    claim <= select & known & (bus_check | bus_read);
    refusal   <= !(select && known) ? VERDICT_OK :
                 bus_check          ? check_refusal :
                 bus_read           ? read_refusal : VERDICT_OK;
    read_data <= (select && bus_read) ? value : 32'd0;

    {command_zero, command_clear, command_abort, command_stop} <= 4'd0;
    if (select && bus_write)
      case (bus_address)
        CHANNEL_COMMAND:        {command_zero, command_clear, command_abort, command_stop} <= bus_data[3:0];
        CHANNEL_RATE_TARGET:    rate_target <= bus_data[16:0];
        CHANNEL_RATE_SLEW:      rate_slew <= bus_data[16:0];
        CHANNEL_STOP_SLEW:      stop_slew <= bus_data[16:0];
        CHANNEL_DRAIN_VELOCITY: drain_velocity <= bus_data;
        default:                ;
      endcase

    if (rst) begin
      claim                                                      <= 1'b0;
      refusal                                                    <= VERDICT_OK;
      read_data                                                  <= 32'd0;
      rate_target                                                <= CHANNEL_RATE_TARGET_RESET;
      rate_slew                                                  <= CHANNEL_RATE_SLEW_RESET;
      stop_slew                                                  <= CHANNEL_STOP_SLEW_RESET;
      drain_velocity                                             <= CHANNEL_DRAIN_VELOCITY_RESET;
      {command_zero, command_clear, command_abort, command_stop} <= 4'd0;
    end
  end

endmodule
`resetall
