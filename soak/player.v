// SPDX-License-Identifier: MIT
// Replays a recorded history to the core and compares every output pin after every clock.
//
// Each line of the record is a run of clocks (hexadecimal count) with its inputs and the outputs after each of them.
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
  parameter STEP_RESET      = 0,
  parameter DIR_RESET       = 0,
  parameter ENABLE_RESET    = 0
);

  localparam PINS = CHANNELS * AXES;

  reg clk = 1'b0;
  reg rst = 1'b0;
  reg sync = 1'b0;
  reg spi_cs_n = 1'b1;
  reg spi_mosi = 1'b0;
  reg spi_sclk = 1'b0;
  wire spi_miso, spi_miso_enable, irq;
  wire [PINS-1:0] step, dir, enable;
  wire [CHANNELS-1:0] running;

  reg [1023:0] name;
  integer file, found;
  reg [31:0] clocks, clock;
  reg [4:0] pins;
  reg [PINS-1:0] step_wanted, dir_wanted, enable_wanted;
  reg [CHANNELS-1:0] running_wanted;
  reg irq_wanted, miso_wanted;
  reg same;

  passo_spi_top #(
    .CHANNELS       (CHANNELS),
    .AXES           (AXES),
    .TICK_LOG2      (TICK_LOG2),
    .LINE_QUEUE_LOG2(LINE_QUEUE_LOG2),
    .RAMP_QUEUE_LOG2(RAMP_QUEUE_LOG2),
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
    found = 8;
    while (same && found == 8) begin
      found = $fscanf(
          file,
          "%h %h %h %h %h %h %h %h\n",
          clocks,
          pins,
          step_wanted,
          dir_wanted,
          enable_wanted,
          running_wanted,
          irq_wanted,
          miso_wanted
      );
      if (found == 8) {rst, sync, spi_cs_n, spi_mosi, spi_sclk} = pins;
      while (same && found == 8 && clocks != 32'd0) begin
        tick;
        clock = clock + 32'd1;
        clocks = clocks - 32'd1;
        same   = {step, dir, enable, running, irq, spi_miso} === {step_wanted, dir_wanted, enable_wanted,
                                                                running_wanted, irq_wanted, miso_wanted};
      end
    end
    if (same) $display("same %0d", clock);
    else
      $display(
          "clock %0d: step %h %h dir %h %h enable %h %h running %h %h irq %b %b miso %b %b",
          clock,
          step,
          step_wanted,
          dir,
          dir_wanted,
          enable,
          enable_wanted,
          running,
          running_wanted,
          irq,
          irq_wanted,
          spi_miso,
          miso_wanted
      );
    $finish;
  end

endmodule
`resetall
