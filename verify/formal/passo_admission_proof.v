// SPDX-License-Identifier: MIT
// Promises of the admission, at its ports.
`resetall
`default_nettype none

module passo_admission_proof (
  input wire clk,
  input wire rst,
  input wire bus_frame,
  input wire bus_commit,
  input wire needs_idle,
  input wire needs_quiet,
  input wire needs_motion,
  input wire tables_wanted,
  input wire occupied,
  input wire at_rest,
  input wire takes_now,
  input wire stopped,        // the motion is stopped
  input wire pins_written
);

  wire quiet = at_rest & ~occupied;
  wire busy;
  wire hold;
  wire now_coming;

  passo_admission u_admission (
    .clk          (clk),
    .rst          (rst),
    .bus_frame    (bus_frame),
    .bus_commit   (bus_commit),
    .needs_idle   (needs_idle),
    .needs_quiet  (needs_quiet),
    .needs_motion (needs_motion),
    .tables_wanted(tables_wanted),
    .occupied     (occupied),
    .at_rest      (at_rest),
    .takes_now    (takes_now),
    .busy         (busy),
    .hold         (hold),
    .now_coming   (now_coming)
  );

  // --- Assumptions: the link, the motion, the pins and the ramp
  reg f_started = 1'b0;
  reg f_reset = 1'b1;  // in the clock before
  reg f_hold = 1'b0;  // one and two clocks ago
  reg f_hold_q = 1'b0;
  reg f_now_coming = 1'b0;
  reg f_executed = 1'b0;  // the frame is being executed
  always @(posedge clk) begin
    f_started    <= 1'b1;
    f_reset      <= rst;
    f_hold       <= hold & ~rst;
    f_hold_q     <= f_hold & ~rst;
    f_now_coming <= now_coming & ~rst;
    f_executed   <= bus_commit & (bus_frame | f_executed) & ~rst;
    if (!f_started) admission_reset : assume (rst);
    if (bus_commit) admission_checks_before : assume (!needs_idle && !needs_quiet && !needs_motion);
    if (pins_written) admission_pins_in_execution : assume (f_executed);
    if (!f_reset) begin
      if (f_hold && f_hold_q && !$past(occupied)) admission_none_begins : assume (!occupied);
      if ($past(quiet && !pins_written)) admission_quiet_lasts : assume (quiet || occupied);
      if (f_now_coming && $past(takes_now && !stopped)) admission_now_waited_for : assume (takes_now || stopped);
    end
  end

  // --- What the frame needs, from the checks of its words
  reg f_idle = 1'b0;
  reg f_quiet = 1'b0;
  reg f_motion = 1'b0;
  reg [1:0] f_age = 2'd0;  // clocks of the commit before this one, up to 3
  always @(posedge clk) begin
    f_idle   <= f_idle | needs_idle;
    f_quiet  <= f_quiet | needs_quiet;
    f_motion <= f_motion | needs_motion;
    f_age    <= !bus_commit || rst ? 2'd0 : f_age == 2'd3 ? 2'd3 : f_age + 2'd1;
    if (rst || (bus_frame && !bus_commit)) {f_idle, f_quiet, f_motion} <= 3'b000;
  end

  always @(posedge clk)
    if (f_started && !f_reset && !rst && bus_commit) begin
      busy_if_not_met : assert (busy == ((f_idle && occupied) || (f_quiet && !quiet) || (f_motion && !takes_now)));
      if (f_age >= 2'd2) begin
        if (!$past(busy) && !stopped && !$past(stopped) && !f_executed) stays_admitted : assert (!busy);
        if ((f_idle || f_quiet) && !$past(occupied)) none_begins_in_commit : assert (!occupied);
        if ($past(tables_wanted) && $past(tables_wanted, 2) && !$past(occupied)) none_begins_with_tables : assert (!occupied);
        if (f_motion && $past(takes_now && !stopped)) motion_goes_on : assert (takes_now || stopped);
      end
    end

  (* keep *) wire f_idle_needed;
  (* keep *) wire f_quiet_needed;
  (* keep *) wire f_motion_needed;
  always @(posedge clk)
    if (f_started)
      assert (f_reset || (f_idle_needed == (f_idle || f_quiet) && f_quiet_needed == f_quiet && f_motion_needed == f_motion));

endmodule
`resetall
