// SPDX-License-Identifier: MIT
// Passo: a step-pulse generator behind a host interface. Frames in, STEP/DIR out, CHANNELS independent groups of
// AXES coordinated axes. Wiring, and what the channels share: the sync input and the slew tick.
//
// The host interface delivers the words of a frame in halves of 16 bits and takes the words of the reply: passo_spi
// over SPI, passo_words for a bus in the same FPGA. Instantiate a top: passo_spi_top, passo_wishbone, passo_axi_lite.
//
// Reset: rst synchronous, active high.
// Latency: a rising edge of `sync` starts the armed channels 4 clocks later.
`resetall
`timescale 1ns / 1ps
`default_nettype none

module passo_core #(
  parameter integer CHANNELS = 1,  // 1 .. 8
  parameter integer AXES = 4,  // per channel, 1 .. 8
  parameter integer TICK_LOG2 = 7,  // clocks per tick, 7 .. 16
  parameter integer LINE_QUEUE_LOG2 = 8,  // log2 of the places for lines, 2 .. 8
  parameter integer RAMP_QUEUE_LOG2 = 4,  // log2 of the places for ramps, 2 .. 8
  parameter integer STEPS_REGISTER = 0,  // 1: block RAMs have an output register
  parameter integer INPUTS = 0,  // 1: limits, home, alarm, probe, e-stop
  parameter integer ENCODERS = 0,  // 1: encoders
  parameter integer OUTPUTS = 0,  // 1: outputs bound to the path
  parameter integer RASTER = 0,  // 1, with OUTPUTS: raster lines
  parameter integer COMPARE = 0,  // 1, with OUTPUTS: pulses at positions
  parameter integer TRACKERS = 0,  // 1: a second hand on every axis
  parameter integer TRACKED = 0,  // the last axes of a channel have no lines: only their trackers move them
  parameter [31:0] CLOCK_HZ = 0,  // of clk, for the host to read; 0: not told
  parameter [31:0] BUILD = 0,  // identifies the bitstream, for the host to read
  // pin levels from configuration until the host writes polarities; bit channel * AXES + axis
  parameter [CHANNELS*AXES-1:0] STEP_RESET = 0,
  parameter [CHANNELS*AXES-1:0] DIR_RESET = 0,
  parameter [CHANNELS*AXES-1:0] ENABLE_RESET = 0
) (
  input  wire                     clk,
  input  wire                     rst,
  // host interface
  input  wire                     frame_start,    // strobes
  input  wire                     frame_end,
  input  wire                     half_valid,
  input  wire                     half_low,       // lower half of a word
  input  wire [             15:0] half,
  output wire [             31:0] reply_word,
  // starts several chips on one edge
  input  wire                     sync,
  // machine: bit channel * AXES + axis; ignored without INPUTS
  input  wire [CHANNELS*AXES-1:0] limit_low,
  input  wire [CHANNELS*AXES-1:0] limit_high,
  input  wire [CHANNELS*AXES-1:0] home,
  input  wire [CHANNELS*AXES-1:0] alarm,
  input  wire [     CHANNELS-1:0] probe,
  /* verilator lint_off UNUSEDSIGNAL */
  input  wire                     estop_n,        // asynchronous
  // encoders; ignored without ENCODERS
  input  wire [CHANNELS*AXES-1:0] encoder_a,
  input  wire [CHANNELS*AXES-1:0] encoder_b,
  input  wire [CHANNELS*AXES-1:0] encoder_index,
  /* verilator lint_on UNUSEDSIGNAL */
  // drives: bit channel * AXES + axis
  output wire [CHANNELS*AXES-1:0] step,
  output wire [CHANNELS*AXES-1:0] dir,
  output wire [CHANNELS*AXES-1:0] enable,
  // outputs bound to the path; 0 without OUTPUTS
  output wire [   CHANNELS*8-1:0] outputs,
  output wire [     CHANNELS-1:0] power,
  output wire [     CHANNELS-1:0] compare,
  // to the host
  output wire [     CHANNELS-1:0] running,
  output reg                      irq             // a channel is stopped
);

  `include "passo_registers.vh"

  generate
    if (CHANNELS < 1 || CHANNELS > 8) begin : g_bad_channels
      passo_parameter_CHANNELS_must_be_1_to_8 u_error ();
    end
    if (AXES < 1 || AXES > 8) begin : g_bad_axes
      passo_parameter_AXES_must_be_1_to_8 u_error ();
    end
    if (TICK_LOG2 < 7 || TICK_LOG2 > 16) begin : g_bad_tick
      passo_parameter_TICK_LOG2_must_be_7_to_16 u_error ();
    end
    if (LINE_QUEUE_LOG2 < 2 || LINE_QUEUE_LOG2 > 8) begin : g_bad_line_queue
      passo_parameter_LINE_QUEUE_LOG2_must_be_2_to_8 u_error ();
    end
    if (INPUTS < 0 || INPUTS > 1) begin : g_bad_inputs
      passo_parameter_INPUTS_must_be_0_or_1 u_error ();
    end
    if (ENCODERS < 0 || ENCODERS > 1) begin : g_bad_encoders
      passo_parameter_ENCODERS_must_be_0_or_1 u_error ();
    end
    if (OUTPUTS < 0 || OUTPUTS > 1) begin : g_bad_outputs
      passo_parameter_OUTPUTS_must_be_0_or_1 u_error ();
    end
    if (RASTER < 0 || RASTER > 1 || (RASTER != 0 && OUTPUTS == 0)) begin : g_bad_raster
      passo_parameter_RASTER_must_be_0_or_with_OUTPUTS_1 u_error ();
    end
    if (COMPARE < 0 || COMPARE > 1 || (COMPARE != 0 && OUTPUTS == 0)) begin : g_bad_compare
      passo_parameter_COMPARE_must_be_0_or_with_OUTPUTS_1 u_error ();
    end
    if (TRACKERS < 0 || TRACKERS > 1) begin : g_bad_trackers
      passo_parameter_TRACKERS_must_be_0_or_1 u_error ();
    end
    if (TRACKED < 0 || TRACKED >= AXES || (TRACKED != 0 && TRACKERS == 0)) begin : g_bad_tracked
      passo_parameter_TRACKED_must_be_below_AXES_with_TRACKERS u_error ();
    end
    if (RAMP_QUEUE_LOG2 < 2 || RAMP_QUEUE_LOG2 > 8) begin : g_bad_ramp_queue
      passo_parameter_RAMP_QUEUE_LOG2_must_be_2_to_8 u_error ();
    end
  endgenerate

  // bus
  wire [ 7:0] last_sequence;
  wire        bus_frame;
  wire        bus_commit;
  wire        bus_check;
  wire        bus_write;
  wire        bus_read;
  wire        bus_push;
  wire [11:0] bus_address;
  wire [31:0] bus_data;
  wire [ 4:0] bus_msb;
  wire        bus_one_hot;
  wire        bus_counters;
  wire        bus_claim;
  reg  [ 3:0] bus_refusal;
  reg  [31:0] bus_read_data;
  reg  [31:0] read_data;

  wire [            3:0] rules_refusal;
  wire                   needs_quiet;
  wire                   registers_bad_value;
  wire [           31:0] registers_read_data;
  wire                   tables_wanted;
  wire [   CHANNELS-1:0] channel_bad_value;
  wire [ CHANNELS*4-1:0] channel_refusal;
  wire [CHANNELS*32-1:0] channel_read_data;
  wire [   CHANNELS-1:0] channel_incomplete;
  wire [   CHANNELS-1:0] channel_busy;

  // channels
  wire [                    CHANNELS-1:0] run;
  wire [                    CHANNELS-1:0] wait_sync;
  wire [                    CHANNELS-1:0] stopped;
  wire [                    CHANNELS-1:0] occupied;
  wire [CHANNELS*(LINE_QUEUE_LOG2+1)-1:0] line_room;
  wire [CHANNELS*(RAMP_QUEUE_LOG2+1)-1:0] ramp_room;
  wire [                    CHANNELS-1:0] table_request;
  wire [                 CHANNELS*10-1:0] table_address;
  wire [                    CHANNELS-1:0] table_served;
  wire [                            15:0] table_point;
  wire [                            15:0] table_point_next;

  // inputs of the machine
  wire                filter_tick;
  wire [        15:0] filter;
  wire                write_filter;
  wire                estop_pressed;
  wire                estop;
  wire                watchdog_stop;
  wire                disable_drives;
  /* verilator lint_off UNUSEDSIGNAL */
  wire [CHANNELS-1:0] moving;
  /* verilator lint_on UNUSEDSIGNAL */
  wire [        31:0] machine_read_data;

  // Unselected targets drive 0.
  integer i;
  always @* begin
    bus_refusal = rules_refusal;
    read_data   = registers_read_data | machine_read_data;
    for (i = 0; i < CHANNELS; i = i + 1) begin
      bus_refusal = bus_refusal | channel_refusal[i*4+:4];
      read_data   = read_data | channel_read_data[i*32+:32];
    end
  end

  // Shape banks 1 .. 3 are the last three blocks of 256 addresses.
  reg select_tables;  // one clock after the address, in time for the strobe

  (* async_reg = "true" *)
  reg  [          2:0] sync_q;
  wire                 sync_edge = sync_q[1] & ~sync_q[2];
  reg  [TICK_LOG2-1:0] slew_count;
  reg                  slew_tick;

  always @(posedge clk) begin
    bus_read_data <= read_data;
    select_tables <= bus_address[11:10] == ADDRESS_COSINE_BASE[11:10] && bus_address[9:8] != 2'd0;
    sync_q        <= {sync_q[1:0], sync};
    slew_count    <= slew_count + 1'b1;
    slew_tick     <= slew_count == {TICK_LOG2{1'b1}};
    irq           <= stopped != {CHANNELS{1'b0}};
    if (rst) begin
      sync_q     <= 3'b111;
      slew_count <= {TICK_LOG2{1'b0}};
      slew_tick  <= 1'b0;
      irq        <= 1'b0;
    end
  end

  passo_link u_link (
    .clk           (clk),
    .rst           (rst),
    .frame_start   (frame_start),
    .frame_end     (frame_end),
    .half_valid    (half_valid),
    .half_low      (half_low),
    .half          (half),
    .reply_word    (reply_word),
    .last_sequence (last_sequence),
    .bus_frame     (bus_frame),
    .bus_commit    (bus_commit),
    .bus_check     (bus_check),
    .bus_write     (bus_write),
    .bus_read      (bus_read),
    .bus_push      (bus_push),
    .bus_address   (bus_address),
    .bus_data      (bus_data),
    .bus_msb       (bus_msb),
    .bus_one_hot   (bus_one_hot),
    .bus_claim     (bus_claim),
    .bus_refusal   (bus_refusal),
    .bus_read_data (bus_read_data),
    .bus_counters  (bus_counters),
    .bus_incomplete(channel_incomplete != {CHANNELS{1'b0}}),
    .bus_busy      (channel_busy != {CHANNELS{1'b0}} || (tables_wanted && occupied != {CHANNELS{1'b0}}))
  );

  passo_rules #(
    .CHANNELS(CHANNELS),
    .AXES    (AXES),
    .INPUTS  (INPUTS),
    .ENCODERS(ENCODERS),
    .OUTPUTS (OUTPUTS),
    .RASTER  (RASTER),
    .COMPARE (COMPARE),
    .TRACKERS(TRACKERS)
  ) u_rules (
    .clk        (clk),
    .rst        (rst),
    .bus_check  (bus_check),
    .bus_read   (bus_read),
    .bus_push   (bus_push),
    .bus_address(bus_address),
    .bus_odd    (bus_data[0]),
    .bus_msb    (bus_msb),
    .bus_one_hot(bus_one_hot),
    .bad_value  (registers_bad_value || channel_bad_value != {CHANNELS{1'b0}}),
    .claim      (bus_claim),
    .refusal    (rules_refusal),
    .needs_quiet(needs_quiet)
  );

  passo_registers #(
    .CHANNELS       (CHANNELS),
    .AXES           (AXES),
    .TICK_LOG2      (TICK_LOG2),
    .LINE_QUEUE_LOG2(LINE_QUEUE_LOG2),
    .RAMP_QUEUE_LOG2(RAMP_QUEUE_LOG2),
    .INPUTS         (INPUTS),
    .ENCODERS       (ENCODERS),
    .OUTPUTS        (OUTPUTS),
    .RASTER         (RASTER),
    .COMPARE        (COMPARE),
    .TRACKERS       (TRACKERS),
    .TRACKED        (TRACKED),
    .CLOCK_HZ       (CLOCK_HZ),
    .BUILD          (BUILD)
  ) u_registers (
    .clk          (clk),
    .rst          (rst),
    .bus_write    (bus_write),
    .bus_read     (bus_read),
    .bus_address  (bus_address),
    .bus_data     (bus_data[18:0]),
    .bad_value    (registers_bad_value),
    .read_data    (registers_read_data),
    .is_counters  (bus_counters),
    .last_sequence(last_sequence),
    .run          (run),
    .wait_sync    (wait_sync),
    .any_stopped  (stopped != {CHANNELS{1'b0}}),
    .any_occupied (occupied != {CHANNELS{1'b0}}),
    .line_room    (line_room),
    .ramp_room    (ramp_room)
  );

  passo_tables #(
    .CHANNELS(CHANNELS)
  ) u_tables (
    .clk        (clk),
    .rst        (rst),
    .bus_frame  (bus_frame),
    .bus_commit (bus_commit),
    .bus_check  (bus_check),
    .bus_write  (bus_write),
    .select     (select_tables),
    .bus_address(bus_address[9:0]),
    .bus_data   (bus_data[15:0]),
    .wanted     (tables_wanted),
    .request    (table_request),
    .address    (table_address),
    .served     (table_served),
    .point      (table_point),
    .point_next (table_point_next)
  );

  generate
    if (INPUTS != 0) begin : g_machine
      passo_machine #(
        .TICK_LOG2(TICK_LOG2)
      ) u_machine (
        .clk           (clk),
        .rst           (rst),
        .bus_write     (bus_write),
        .bus_read      (bus_read),
        .bus_address   (bus_address),
        .bus_data      (bus_data[19:0]),
        .read_data     (machine_read_data),
        .estop_n       (estop_n),
        .moving        (moving != {CHANNELS{1'b0}}),
        .slew_tick     (slew_tick),
        .tick          (filter_tick),
        .filter        (filter),
        .write_filter  (write_filter),
        .pressed       (estop_pressed),
        .estop         (estop),
        .watchdog_stop (watchdog_stop),
        .disable_drives(disable_drives)
      );
    end else begin : g_no_machine
      assign machine_read_data = 32'd0;
      assign filter_tick       = 1'b0;
      assign filter            = 16'd0;
      assign write_filter      = 1'b0;
      assign estop_pressed     = 1'b0;
      assign estop             = 1'b0;
      assign watchdog_stop     = 1'b0;
      assign disable_drives    = 1'b0;
    end
  endgenerate

  genvar channel;
  generate
    for (channel = 0; channel < CHANNELS; channel = channel + 1) begin : g_channel
      localparam [3:0] BLOCK = channel + 1;

      passo_channel #(
        .AXES           (AXES),
        .TICK_LOG2      (TICK_LOG2),
        .LINE_QUEUE_LOG2(LINE_QUEUE_LOG2),
        .RAMP_QUEUE_LOG2(RAMP_QUEUE_LOG2),
        .STEPS_REGISTER (STEPS_REGISTER),
        .INPUTS         (INPUTS),
        .ENCODERS       (ENCODERS),
        .OUTPUTS        (OUTPUTS),
        .RASTER         (RASTER),
        .COMPARE        (COMPARE),
        .TRACKERS       (TRACKERS),
        .TRACKED        (TRACKED),
        .STEP_RESET     (STEP_RESET[channel*AXES+:AXES]),
        .DIR_RESET      (DIR_RESET[channel*AXES+:AXES]),
        .ENABLE_RESET   (ENABLE_RESET[channel*AXES+:AXES])
      ) u_channel (
        .clk             (clk),
        .rst             (rst),
        .bus_frame       (bus_frame),
        .bus_commit      (bus_commit),
        .bus_check       (bus_check),
        .bus_write       (bus_write),
        .bus_read        (bus_read),
        .bus_push        (bus_push),
        .select          (bus_address[11:8] == BLOCK),
        .bus_address     (bus_address[7:0]),
        .bus_data        (bus_data),
        .bus_msb         (bus_msb),
        .needs_quiet     (needs_quiet),
        .bad_value       (channel_bad_value[channel]),
        .refusal         (channel_refusal[channel*4+:4]),
        .read_data       (channel_read_data[channel*32+:32]),
        .incomplete      (channel_incomplete[channel]),
        .busy            (channel_busy[channel]),
        .tables_wanted   (tables_wanted),
        .run             (run[channel]),
        .wait_sync       (wait_sync[channel]),
        .sync_edge       (sync_edge),
        .slew_tick       (slew_tick),
        .snapshot        (frame_start),
        .stopped         (stopped[channel]),
        .occupied        (occupied[channel]),
        .line_room       (line_room[channel*(LINE_QUEUE_LOG2+1)+:LINE_QUEUE_LOG2+1]),
        .ramp_room       (ramp_room[channel*(RAMP_QUEUE_LOG2+1)+:RAMP_QUEUE_LOG2+1]),
        .table_request   (table_request[channel]),
        .table_address   (table_address[channel*10+:10]),
        .table_served    (table_served[channel]),
        .table_point     (table_point),
        .table_point_next(table_point_next),
        .filter_tick     (filter_tick),
        .filter          (filter),
        .write_filter    (write_filter),
        .estop_pressed   (estop_pressed),
        .estop           (estop),
        .watchdog_stop   (watchdog_stop),
        .disable_drives  (disable_drives),
        .limit_low       (limit_low[channel*AXES+:AXES]),
        .limit_high      (limit_high[channel*AXES+:AXES]),
        .home            (home[channel*AXES+:AXES]),
        .alarm           (alarm[channel*AXES+:AXES]),
        .probe           (probe[channel]),
        .moving          (moving[channel]),
        .encoder_a       (encoder_a[channel*AXES+:AXES]),
        .encoder_b       (encoder_b[channel*AXES+:AXES]),
        .encoder_index   (encoder_index[channel*AXES+:AXES]),
        .step            (step[channel*AXES+:AXES]),
        .dir             (dir[channel*AXES+:AXES]),
        .enable          (enable[channel*AXES+:AXES]),
        .outputs         (outputs[channel*8+:8]),
        .power           (power[channel]),
        .compare         (compare[channel]),
        .running         (running[channel])
      );
    end
  endgenerate

`ifdef FORMAL
  `include "passo_core_formal.vh"
`endif

endmodule
`resetall
