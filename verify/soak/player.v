// SPDX-License-Identifier: MIT
// Replays a recorded history to the core and compares every output pin after every clock.
//
// Each line of the record is a run of clocks (hexadecimal count) with its inputs and the outputs after each of them, in
// the order of player_pins.vh. A run of 0 clocks: the outputs follow the inputs asynchronously.
// Plusarg: +record=FILE. Prints "same CLOCKS", or the first difference.
`resetall
`default_nettype none
`timescale 1ns / 1ns

module soak_player #(
  parameter CHANNELS        = 1,
  parameter AXES            = 1,
  parameter TICK_LOG2       = 7,
  parameter LINE_QUEUE_LOG2 = 5,
  parameter RAMP_QUEUE_LOG2 = 3,
  parameter INPUTS          = 0,
  parameter ENCODERS        = 0,
  parameter OUTPUTS         = 0,
  parameter RASTER          = 0,
  parameter COMPARE         = 0,
  parameter TRACKERS        = 0,
  parameter TRACKED         = 0,
  parameter CLOCK_HZ        = 0,
  parameter BUILD           = 0,
  parameter STEP_RESET      = 0,
  parameter DIR_RESET       = 0,
  parameter ENABLE_RESET    = 0
);

  reg  clk = 1'b0;
  wire spi_miso_enable;

  `include "player_pins.vh"

  localparam WORDS = INPUT_COUNT + OUTPUT_COUNT;

  reg [1023:0] name;
  integer file, found, word;
  reg [31:0] clocks, clock;
  reg [        63:0] level;
  reg [64*WORDS-1:0] levels;
  reg                same;

  passo_spi_top #(
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
    .BUILD          (BUILD),
    .STEP_RESET     (STEP_RESET),
    .DIR_RESET      (DIR_RESET),
    .ENABLE_RESET   (ENABLE_RESET)
  ) u_core (
    .*
  );

  // Inputs change between two rising edges; outputs are compared before that.
  task tick;
    begin
      #1 clk = 1'b1;
      #1 clk = 1'b0;
    end
  endtask

  initial begin
    if (!$value$plusargs("record=%s", name)) name = "record.txt";
    file     = $fopen(name, "r");
    // power-up: chip select rises as with a pull-up
    spi_cs_n = 1'b0;
    rst      = 1'b1;
    repeat (4) tick;
    spi_cs_n = 1'b1;
    repeat (4) tick;
    rst   = 1'b0;
    clock = 32'd0;
    same  = file != 0;
    found = 1;
    while (same && found == 1) begin
      found = $fscanf(file, "%h", clocks);
      for (word = 0; found == 1 && word < WORDS; word = word + 1) begin
        found               = $fscanf(file, "%h", level);
        levels[64*word+:64] = level;
      end
      if (found == 1) begin
        set_inputs(levels[64*INPUT_COUNT-1:0]);
        wanted = levels[64*WORDS-1:64*INPUT_COUNT];
        if (clocks == 32'd0) begin
          #1 same = seen === wanted;
        end
      end
      while (same && found == 1 && clocks != 32'd0) begin
        tick;
        clock  = clock + 32'd1;
        clocks = clocks - 32'd1;
        same   = seen === wanted;
      end
    end
    if (same) $display("same %0d", clock);
    else tell_difference(clock);
    $finish;
  end

endmodule
`resetall
