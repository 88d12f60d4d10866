// SPDX-License-Identifier: MIT
// Motion: start, end and stop of a channel's motions, and the stop cause.
//
//   IDLE -> PREPARE -> ARMED -> RUN -> SETTLE -> (DRAIN -> SETTLE) -> IDLE;  anything -> STOPPED -> IDLE
//
// Promise: a motion is prepared when `run` is set and a line and a ramp are queued, but not while `hold`. From ARMED
// it starts when it `may_begin`, immediately or, while wait_sync is set, on a sync edge, or later if it may not begin
// then; so ARMED channels start together when one write clears their wait_sync. While the inputs are not `known` it is
// neither prepared nor started, and a sync edge is ignored. It ends when its profile has ended and its line has ended
// (or is ENDLESS); missing substeps of the line are drained and counted. A stop is soft (the rate goes to 0 first) for
// COMMAND.STOP, RAMP_UNDERRUN and soft requests of inputs and encoders, else the channel is STOPPED two clocks later.
// Encoders only stop a motion. On the same clock e-stop has priority, then ABORT, STEP_OVERRUN, hard requests of
// inputs, those of encoders, LINE_UNDERRUN, a soft stop (STOP, inputs, RAMP_UNDERRUN, encoders); a stop has priority
// over the end of the motion. A hard stop overrides a soft stop in progress; the first cause is kept. `drop` is high
// from e-stop, ABORT or a hard request until no further step can be requested.
//
// `running` is the motion as seen at the STEP pins: it rises 7 clocks after RUN begins and falls one clock after
// SETTLE, so that it is high for exactly the length of the profile, and until the last drained step is output.
`resetall
`timescale 1ns / 1ps
`default_nettype none

module passo_motion (
  input  wire        clk,
  input  wire        rst,
  // host
  input  wire        run,
  input  wire        wait_sync,
  input  wire        sync_edge,
  input  wire        hold,
  input  wire        command_stop,      // strobes
  input  wire        command_abort,
  input  wire        command_clear,
  // inputs of the machine: requests to stop
  input  wire        estop,             // hard
  input  wire        input_hard,
  input  wire [ 3:0] input_hard_cause,
  input  wire        input_soft,
  input  wire [ 3:0] input_soft_cause,
  // encoders
  input  wire        may_begin,         // an ARMED motion need not wait for an index
  input  wire        known,             // no motion need wait for its inputs
  input  wire        following_soft,    // an axis is too far from its encoder: requests to stop
  input  wire        following_hard,
  // trackers
  input  wire        tracking,          // an axis moves, without a motion or beside it
  output wire [ 2:0] state,
  output reg  [ 3:0] cause,
  output reg         stopping,
  output reg  [14:0] drained,
  // timescale
  output wire        occupied,          // a motion is prepared or running
  output reg         moving,            // the profile runs, settles, or substeps are drained
  output reg         counting,          // the profile runs, or substeps are drained
  input  wire        rate_is_zero,
  // ramp and path
  input  wire        ramp_valid,
  input  wire        ramp_ready,
  input  wire        ramp_ended,
  input  wire        ramp_dry,
  output wire        prepare,           // strobe: take the first line, compute the first velocity
  output reg         begin_profile,     // strobe
  output wire        drain,
  // line
  input  wire        line_valid,
  input  wire        line_ended,
  input  wire        line_endless,
  input  wire        line_underrun,
  input  wire        substep_made,
  // axes
  input  wire        step_overrun,
  output wire        drop,
  // queues
  output wire        release_line,      // strobe: the motion is over
  output reg         stopped,           // holds the datapath of the motion in reset
  output reg         running,
  output wire        running_next       // its level in the next clock, except for a reset
);

  `include "passo_registers.vh"

  localparam [2:0] START_LAST = 3'd6;  // from RUN to the STEP pin

  reg [2:0] count;  // clocks of RUN, up to START_LAST
  reg [2:0] settling;  // one bit per clock of SETTLE so far
  reg       settled;  // its fifth clock: the last substep needs 2 clocks to the line
  reg       finished;  // settled, and no substep is missing
  reg [3:0] soft_cause;
  reg       startable;  // high for one clock, still in IDLE
  reg       synced;  // there was a sync edge while it was ARMED
  reg       rate_was_zero;
  reg [1:0] aborted;  // one and two clocks ago

  // States, one-hot
  reg idle;
  reg preparing;
  reg armed;
  reg runs;
  reg settles;
  reg drains;

  assign state = stopped   ? STATE_STOPPED :
                 preparing ? STATE_PREPARE :
                 armed     ? STATE_ARMED :
                 runs      ? STATE_RUN :
                 settles   ? STATE_SETTLE :
                 drains    ? STATE_DRAIN : STATE_IDLE;

  assign occupied = ~idle & ~stopped;

  wire runs_next = (begin_profile | runs) & ~ramp_ended;
  wire drains_next = (settled & ~finished) | (drains & ~line_ended);
  wire settled_next = settles & settling[2] & ~settled;
  wire dry = ramp_dry & ~line_endless;
  wire synced_next = armed & known & (sync_edge | synced);
  wire starts = armed & known & may_begin & (synced_next | ~wait_sync);
  wire too_far = following_hard & occupied;
  wire lags = following_soft & occupied;
  wire abort = command_abort | estop | input_hard | too_far;

  assign prepare      = startable;
  assign drain        = drains;
  assign release_line = finished;
  assign drop         = abort | (aborted != 2'b00);

  // Stop decision, registered
  reg stop_due;
  reg [3:0] cause_due;
  wire       stop_wanted = abort | ((moving | tracking) & step_overrun) | (moving & line_underrun)
                  | (stopping & (rate_was_zero | finished | ~moving) & ~tracking);
  wire [3:0] cause_wanted = stopping               ? soft_cause :
                         estop                   ? CAUSE_ESTOP :
                         command_abort           ? CAUSE_ABORT :
                         (moving | tracking) & step_overrun ? CAUSE_STEP_OVERRUN :
                         input_hard              ? input_hard_cause :
                         too_far                 ? CAUSE_FOLLOWING_ERROR :
                         moving & line_underrun  ? CAUSE_LINE_UNDERRUN : soft_cause;

  wire stop_now = stop_due & ~stopped;

  assign running_next = ~stop_now & (~runs | count == START_LAST ? moving : running);

  always @(posedge clk) begin
    idle      <= (idle & ~startable) | finished | (stopped & command_clear);
    preparing <= startable | (preparing & ~ramp_ready);
    armed     <= (preparing & ramp_ready) | (armed & ~begin_profile);
    runs      <= runs_next;
    settles   <= ((begin_profile | runs) & ramp_ended) | (settles & ~settled) | (drains & line_ended);
    drains    <= drains_next;
    moving    <= (moving | begin_profile) & ~finished;
    counting  <= runs_next | drains_next;
    if (stopped && command_clear) begin
      stopped <= 1'b0;
      cause   <= CAUSE_NONE;
    end
    if (stop_now) begin
      {idle, preparing, armed, runs, settles, drains, moving, counting} <= 8'd0;

      stopped <= 1'b1;
      cause   <= cause_due;
    end
    if (rst) begin
      {preparing, armed, runs, settles, drains, moving, counting, stopped} <= 8'd0;

      idle  <= 1'b1;
      cause <= CAUSE_NONE;
    end
  end

  always @(posedge clk) begin
    synced        <= synced_next;
    begin_profile <= starts && !begin_profile && !stop_now;
    startable     <= idle && run && line_valid && ramp_valid && known && !startable && !stop_due && !hold;
    stop_due      <= stop_wanted && !stopped;
    cause_due     <= cause_wanted;
    if (count != START_LAST) count <= count + 3'd1;
    if (!runs) count <= 3'd0;
    settling      <= settles ? {settling[1:0], 1'b1} : 3'd0;
    settled       <= settled_next;
    finished      <= settled_next && (line_ended || line_endless);
    rate_was_zero <= rate_is_zero;
    aborted       <= {aborted[0], abort};
    running       <= running_next;

    if (drains && substep_made && !line_ended) drained <= drained + 15'd1;

    if (!stopping && !stopped) begin
      if (command_stop) soft_cause <= CAUSE_STOP;
      else if (input_soft) soft_cause <= input_soft_cause;
      else if (dry) soft_cause <= CAUSE_RAMP_UNDERRUN;
      else if (lags) soft_cause <= CAUSE_FOLLOWING_ERROR;
      stopping <= command_stop | input_soft | dry | lags;
    end

    if (stop_now) begin
      stopping <= 1'b0;
      settled  <= 1'b0;
      finished <= 1'b0;
    end
    if (rst) begin
      stopping      <= 1'b0;
      drained       <= 15'd0;
      startable     <= 1'b0;
      synced        <= 1'b0;
      begin_profile <= 1'b0;
      stop_due      <= 1'b0;
      settled       <= 1'b0;
      finished      <= 1'b0;
      aborted       <= 2'b00;
      running       <= 1'b0;
    end
  end

`ifdef FORMAL
  `include "passo_motion_formal.vh"
`endif

endmodule
`resetall
