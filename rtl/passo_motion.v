// SPDX-License-Identifier: MIT
// Motion: when a channel starts, ends and stops, and why.
//
//   IDLE -> PREPARE -> ARMED -> RUN -> SETTLE -> (DRAIN -> SETTLE) -> IDLE;  anything -> STOPPED -> IDLE
//
// Promise: a motion is prepared when `run` is set and a line and a ramp are there. It starts from ARMED at
// once or, while wait_sync is set, with a sync edge; so channels that are ARMED start together when one write
// clears their wait_sync. It ends when its profile has ended and its line has ended (or is ENDLESS); what the
// line still lacks is drained and counted. A stop is soft (the rate goes to 0 first) for COMMAND.STOP and
// RAMP_UNDERRUN, else at once. On the same clock ABORT wins, then STEP_OVERRUN, LINE_UNDERRUN, a soft stop; a
// stop wins over the end of the motion.
//
// `running` is the motion as seen at the STEP pins: it rises 7 clocks after RUN begins and falls one clock
// after SETTLE, so that it is high for as many clocks as the profile has, and until the last drained step has
// been made.
`resetall
`default_nettype none

module passo_motion (
  input  wire        clk,
  input  wire        rst,
  // host
  input  wire        run,
  input  wire        wait_sync,
  input  wire        sync_edge,
  input  wire        command_stop,   // strobes
  input  wire        command_abort,
  input  wire        command_clear,
  output reg  [ 2:0] state,
  output reg  [ 2:0] cause,
  output reg         stopping,
  output reg  [15:0] drained,
  // timescale
  output wire        occupied,       // a motion is prepared or runs
  output wire        moving,
  output wire        counting,       // enabled clocks count: the profile runs, or substeps are drained
  input  wire        rate_is_zero,
  // ramp and path
  input  wire        ramp_valid,
  input  wire        ramp_ready,
  input  wire        ramp_ended,
  input  wire        ramp_dry,
  output wire        prepare,        // strobe: first line, first velocity
  output wire        begin_profile,  // strobe
  output wire        drain,
  // line
  input  wire        line_valid,
  input  wire        line_ended,
  input  wire        line_endless,
  input  wire        line_underrun,
  input  wire        substep_made,
  // axes
  input  wire        step_overrun,
  // queues
  output wire        release_line,   // strobe: the motion is over
  output wire        stopped,        // whoever works for the motion forgets it
  output reg         running
);

  `include "passo_registers.vh"

  localparam [2:0] START_LAST = 3'd6;  // from RUN to the STEP pin

  reg [2:0] count;  // clocks of RUN, up to START_LAST
  reg [2:0] settling;  // a bit for each clock of SETTLE so far
  reg       settled;  // its fifth clock: the last substep needs 2 clocks to the line
  reg       finished;  // settled, and nothing is missing
  reg [2:0] soft_cause;
  reg       startable;  // for one clock, and still in IDLE
  reg       rate_was_zero;

  assign occupied = state != STATE_IDLE && !stopped;
  assign moving   = state == STATE_RUN || state == STATE_SETTLE || state == STATE_DRAIN;

  wire settles = state == STATE_SETTLE && settling[2] && !settled;
  wire dry = ramp_dry & ~line_endless;

  assign prepare       = startable;
  assign begin_profile = state == STATE_ARMED && (sync_edge || !wait_sync);
  assign counting      = state == STATE_RUN || state == STATE_DRAIN;
  assign drain         = state == STATE_DRAIN;
  assign release_line  = finished;

  wire stop_now = command_abort | (moving & (step_overrun | line_underrun))
                  | (stopping & (rate_was_zero | finished | ~moving));
  wire [2:0] cause_now = command_abort           ? CAUSE_ABORT :
                         moving & step_overrun   ? CAUSE_STEP_OVERRUN :
                         moving & line_underrun  ? CAUSE_LINE_UNDERRUN : soft_cause;

  assign stopped = state == STATE_STOPPED;

  always @(posedge clk) begin
    startable <= state == STATE_IDLE && run && line_valid && ramp_valid && !startable && !stop_now;
    if (count != START_LAST) count <= count + 3'd1;
    if (state != STATE_RUN) count <= 3'd0;
    settling      <= state == STATE_SETTLE ? {settling[1:0], 1'b1} : 3'd0;
    settled       <= settles;
    finished      <= settles && (line_ended || line_endless);
    rate_was_zero <= rate_is_zero;
    case (state)
      STATE_IDLE:    if (startable) state <= STATE_PREPARE;
      STATE_PREPARE: if (ramp_ready) state <= STATE_ARMED;
      STATE_ARMED:   if (begin_profile) state <= ramp_ended ? STATE_SETTLE : STATE_RUN;
      STATE_RUN:     if (ramp_ended) state <= STATE_SETTLE;
      STATE_SETTLE:  if (settled) state <= finished ? STATE_IDLE : STATE_DRAIN;
      STATE_DRAIN:   if (line_ended) state <= STATE_SETTLE;
      default:       ;
    endcase
    if (state == STATE_RUN && count != START_LAST) running <= running;
    else running <= moving;

    if (state == STATE_DRAIN && substep_made && !line_ended) drained <= drained + 16'd1;

    if (!stopping && !stopped) begin
      if (command_stop) soft_cause <= CAUSE_STOP;
      else if (dry) soft_cause <= CAUSE_RAMP_UNDERRUN;
      stopping <= command_stop | dry;
    end

    if (stopped && command_clear) begin
      state <= STATE_IDLE;
      cause <= CAUSE_NONE;
    end
    if (stop_now && !stopped) begin
      state    <= STATE_STOPPED;
      cause    <= cause_now;
      stopping <= 1'b0;
      running  <= 1'b0;
      settled  <= 1'b0;
      finished <= 1'b0;
    end
    if (rst) begin
      state     <= STATE_IDLE;
      cause     <= CAUSE_NONE;
      stopping  <= 1'b0;
      drained   <= 16'd0;
      startable <= 1'b0;
      settled   <= 1'b0;
      finished  <= 1'b0;
      running   <= 1'b0;
    end
  end

`ifdef FORMAL
  `include "passo_motion_formal.vh"
`endif

endmodule
`resetall
